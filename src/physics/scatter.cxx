#include "physics/scatter.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "core/random.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cdem {

bool Scatters(const Property &property) {
  for (const char *unit : {"Pa", "Pa/m", "degrees", "J/m^2"})
    if (std::strcmp(property.unit, unit) == 0) return std::strcmp(property.key, "dilation") != 0;
  return false;
}

double Scatter::Draw(double mean, double u0, double u1) const {
  switch (kind) {
    case kWeibull:
      return mean * std::pow(-std::log(u0), 1 / spread) / std::tgamma(1 + 1 / spread);
    case kNormal:  // Box and Muller
      return mean * (1 + spread * std::sqrt(-2 * std::log(u0)) * std::cos(2 * 3.14159265358979323846 * u1));
    case kUniform:
      return mean * (1 + spread * (2 * u0 - 1));
    case kNone:
      break;
  }
  return mean;
}

PetscErrorCode ReadScatter(Options &options, const OptionKey &key, Scatter *scatter, bool *set) {
  PetscFunctionBeginUser;
  std::string text;
  PetscCall(options.Text(key, &text, set));
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  const std::size_t colon = text.find(':');
  const std::string law = text.substr(0, colon), number = colon == std::string::npos ? "" : text.substr(colon + 1);
  char *end = nullptr;
  scatter->spread = std::strtod(number.c_str(), &end);
  scatter->kind = law == "weibull"   ? Scatter::kWeibull
                  : law == "normal"  ? Scatter::kNormal
                  : law == "uniform" ? Scatter::kUniform
                                     : Scatter::kNone;
  const std::string spelled = Options::Spelled(key);
  CdemCheck(scatter->kind != Scatter::kNone && !number.empty() && *end == '\0' && std::isfinite(scatter->spread),
            options.comm(),
            "%s is '%s'; it is weibull:m (modulus m), normal:s or uniform:d (standard deviation s, half width d, over "
            "the mean)",
            spelled.c_str(), text.c_str());
  CdemCheck(scatter->spread > 0, options.comm(), "%s is '%s'; the number must be above 0", spelled.c_str(),
            text.c_str());
  CdemCheck(scatter->kind != Scatter::kUniform || scatter->spread <= 1, options.comm(),
            "%s is '%s'; a half width above 1 would make negative values", spelled.c_str(), text.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

double ScatteredValue(const Scatter &scatter, const Property &property, double mean, double size_factor,
                      std::int64_t seed, std::uint64_t number) {
  if (scatter.kind == Scatter::kNone || mean == 0) return mean;
  const r123::Philox4x64::key_type key = {{static_cast<std::uint64_t>(seed), KeyNumber(property.key)}};
  const r123::Philox4x64::ctr_type counter = {{number, 0, 0, 0}};
  const auto bits = r123::Philox4x64()(counter, key);
  // 53 bits, never 0 nor 1: a logarithm follows
  const double u0 = (static_cast<double>(bits[0] >> 11) + 0.5) * 0x1p-53,
               u1 = (static_cast<double>(bits[1] >> 11) + 0.5) * 0x1p-53;
  const double value = scatter.Draw(mean * size_factor, u0, u1);
  // cut at zero; what must be positive keeps a thousandth of its mean
  const double low = property.low > 0 ? property.low : property.bounds == kPropertyOpen ? 1e-3 * mean : 0.0;
  return std::min(std::max(value, low), property.high);
}

}  // namespace cdem
