// Strengths and stiffnesses that scatter from element to element and from face to face.
#pragma once
#include "core/petsc.hpp"
#include "physics/law.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace cdem {

class Options;
struct OptionKey;

inline constexpr int kMaxProperties = 20;  ///< properties a law may ask for

/// How a value scatters about its mean.
struct Scatter {
  enum Kind { kNone, kWeibull, kNormal, kUniform } kind = kNone;
  double spread = 0;  ///< Weibull's modulus; standard deviation or half width over the mean

  /// The value of a mean for a uniform number in (0, 1) and, for the normal law, a second one.
  double Draw(double mean, double u0, double u1) const;
};

/// The scatter of every property of a law.
struct ScatterSet {
  std::array<Scatter, kMaxProperties> of{};
  bool any = false;
  std::int64_t seed = 1;
  double volume = 0;  ///< V0 [m^3] of Weibull's size effect (V0/V)^(1/m); 0: none
};

/// A strength or a stiffness scatters; ratios and choices do not.
bool Scatters(const Property &property);

/// Reads `weibull:m`, `normal:s` or `uniform:d`.
PetscErrorCode ReadScatter(Options &options, const OptionKey &key, Scatter *scatter, bool *set);

/// The scattered value of a property of one element or face: a function of the seed, the key and the global number alone.
/// [in] size_factor: multiplies the mean. The value stays in the property's range.
double ScatteredValue(const Scatter &scatter, const Property &property, double mean, double size_factor,
                      std::int64_t seed, std::uint64_t number);

}  // namespace cdem
