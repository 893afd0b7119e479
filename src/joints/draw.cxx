#include "joints/draw.hpp"

#include "core/random.hpp"
#include "core/small.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Sine of an angle in degrees; multiples of 90 are exact, so that a vertical plane is vertical.
double SinDegrees(double angle) {
  const double turn = std::fmod(angle, 360);
  if (std::fmod(turn, 180) == 0) return 0;
  if (turn == 90 || turn == -270) return 1;
  if (turn == 270 || turn == -90) return -1;
  return std::sin(turn * (kPi / 180));
}

/// Integral of x^(q-1) from low to high.
double PowerIntegral(double q, double low, double high) {
  const double span = std::log(high / low);
  return std::pow(low, q) * (std::fabs(q * span) < 1e-12 ? span : std::expm1(q * span) / q);
}

/// Standard deviation of ln D.
double LogSd(const DiameterLaw &law) { return std::sqrt(std::log1p(law.p[1] * law.p[1] / (law.p[0] * law.p[0]))); }
double LogMean(const DiameterLaw &law) { return std::log(law.p[0]) - 0.5 * LogSd(law) * LogSd(law); }

/// Four random numbers of a disc. The key is the name of the set, so that a set keeps its discs when others come or go;
/// the 1 keeps them apart from strengths that scatter.
r123::Philox4x64::ctr_type Random(std::uint64_t n, std::uint64_t block, std::uint64_t seed, std::uint64_t stream) {
  return r123::Philox4x64()({{n, block, 1, 0}}, {{seed, stream}});
}

}  // namespace

void NormalOf(double dip, double dip_direction, double normal[3]) {
  const double s = SinDegrees(dip);
  normal[0] = s * SinDegrees(dip_direction);
  normal[1] = s * SinDegrees(dip_direction + 90);
  normal[2] = SinDegrees(dip + 90);
}

void AnglesOf(const double normal[3], double *dip, double *dip_direction) {
  const double sign = normal[2] < 0 ? -1 : 1, level = std::hypot(normal[0], normal[1]);
  *dip = std::atan2(level, std::fabs(normal[2])) * (180 / kPi);
  *dip_direction = level > 0 ? std::atan2(sign * normal[0], sign * normal[1]) * (180 / kPi) : 0;
  if (*dip_direction < 0) *dip_direction += 360;
  if (*dip_direction >= 360) *dip_direction = 0;
}

void PlaneBasis(const double normal[3], double e0[3], double e1[3]) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(normal[k]) < std::fabs(normal[least])) least = k;
  double axis[3] = {0, 0, 0};
  axis[least] = 1;
  Cross(normal, axis, e0);
  const double length = std::sqrt(Dot(e0, e0));
  for (int k = 0; k < 3; ++k) e0[k] /= length;
  Cross(normal, e0, e1);
}

double DiameterLaw::Largest() const {
  switch (kind) {
    case kFixed:
      return p[0];
    case kUniform:
      return p[1];
    case kLogNormal:
      return std::exp(LogMean(*this) + kCut * LogSd(*this));
    case kPower:
      break;
  }
  return p[2];
}

double DiameterLaw::Mean() const {
  if (kind == kUniform) return 0.5 * (p[0] + p[1]);
  if (kind == kPower) return PowerIntegral(2 - p[0], p[1], p[2]) / PowerIntegral(1 - p[0], p[1], p[2]);
  return p[0];
}

double DiameterLaw::MeanSquare() const {
  switch (kind) {
    case kFixed:
      return p[0] * p[0];
    case kUniform:
      return (p[0] * p[0] + p[0] * p[1] + p[1] * p[1]) / 3;
    case kLogNormal:
      return p[0] * p[0] + p[1] * p[1];
    case kPower:
      break;
  }
  return PowerIntegral(3 - p[0], p[1], p[2]) / PowerIntegral(1 - p[0], p[1], p[2]);
}

DiscSource::DiscSource(const JointLaw &law, std::int64_t seed, const std::string &name, const double lower[3],
                       const double upper[3])
    : law_(law), seed_(static_cast<std::uint64_t>(seed)), stream_(KeyNumber(name)),
      grow_(0.5 * law.diameter.Largest()) {
  std::copy_n(lower, 3, lower_);
  std::copy_n(upper, 3, upper_);
  NormalOf(law.dip, law.dip_direction, mean_);
  PlaneBasis(mean_, e_[0], e_[1]);
}

double DiscSource::Volume() const {
  double volume = 1;
  for (int k = 0; k < 3; ++k) volume *= upper_[k] - lower_[k] + 2 * grow_;
  return volume;
}

/// [in] uniform: of the disc's first block of random numbers; a log-normal D takes further blocks, two numbers at a time.
double DiscSource::Diameter(std::uint64_t n, double uniform) const {
  const DiameterLaw &law = law_.diameter;
  switch (law.kind) {
    case DiameterLaw::kFixed:
      return law.p[0];
    case DiameterLaw::kUniform:
      return law.p[0] + uniform * (law.p[1] - law.p[0]);
    case DiameterLaw::kPower: {
      const double q = 1 - law.p[0], span = std::log(law.p[2] / law.p[1]);
      const double s = std::fabs(q * span) < 1e-12 ? uniform * span : std::log1p(uniform * std::expm1(q * span)) / q;
      return std::min(law.p[1] * std::exp(s), law.p[2]);
    }
    case DiameterLaw::kLogNormal:
      break;
  }
  for (std::uint64_t block = 2;; ++block) {
    const auto bits = Random(n, block, seed_, stream_);
    for (int i = 0; i < 4; i += 2) {
      const double normal = std::sqrt(-2 * std::log1p(-UnitReal(bits[i]))) * std::cos(2 * kPi * UnitReal(bits[i + 1]));
      if (std::fabs(normal) <= DiameterLaw::kCut) return std::exp(LogMean(law) + normal * LogSd(law));
    }
  }
}

bool DiscSource::Draw(std::uint64_t n, Disc *disc) const {
  auto bits = Random(n, 0, seed_, stream_);
  disc->radius = 0.5 * Diameter(n, UnitReal(bits[3]));
  double away = 0;  // from the box, squared
  for (int k = 0; k < 3; ++k) {
    const double low = lower_[k] - grow_, x = low + UnitReal(bits[k]) * (upper_[k] + grow_ - low);
    const double beyond = std::max({lower_[k] - x, x - upper_[k], 0.0});
    disc->centre[k] = x;
    away += beyond * beyond;
  }
  if (away > disc->radius * disc->radius) return false;
  std::copy_n(mean_, 3, disc->normal);
  if (law_.fisher < 0) return true;
  bits = Random(n, 1, seed_, stream_);
  const double u = UnitReal(bits[0]), kappa = law_.fisher;
  const double gap =  // 1 - cos t
      kappa < 1e-12 ? 2 * u : std::min(2.0, -std::log1p(u * std::expm1(-2 * kappa)) / kappa);
  const double sine = std::sqrt(std::max(0.0, gap * (2 - gap))), phi = 2 * kPi * UnitReal(bits[1]);
  const double c = sine * std::cos(phi), s = sine * std::sin(phi);
  for (int k = 0; k < 3; ++k) disc->normal[k] = (1 - gap) * mean_[k] + c * e_[0][k] + s * e_[1][k];
  const double length = std::copysign(std::sqrt(Dot(disc->normal, disc->normal)), disc->normal[2]);
  for (double &x : disc->normal) x /= length;
  return true;
}

}  // namespace cdem
