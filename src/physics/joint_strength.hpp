// What the brittle and the softening law have in common: a Mohr-Coulomb strength with dilation, given by the user.
#pragma once
#include "physics/strength.hpp"

#include <algorithm>

namespace cdem {

/// The properties after those that blocks may give.
enum { kStrengthDilation = kStrengths, kStrengthDilationSlip };

/// A strength that comes from the blocks where it is not given.
constexpr Property StrengthProperty(int which, const char *unit, double high, PropertyBounds bounds, const char *text) {
  return {kStrengthKeys[which], unit, 0, high, bounds, text, kRequired, "", "that of the weaker block"};
}
inline constexpr Property kJointFriction =
    StrengthProperty(kStrengthFriction, "degrees", 89.9, kPropertyClosed, "angle of friction");

inline constexpr Property kDilationProperties[] = {
    {"dilation", "degrees", 0, 89.9, kPropertyClosed, "angle of dilation: sliding opens the joint by its tangent", 0},
    {"dilation_slip", "m", 0, kPropertyInf, kPropertyOpen, "slip after which it dilates no more", kPropertyInf}};

inline double TanOfDegrees(double angle) { return std::tan(angle * kDegree); }

struct StrengthLawDefaults : JointLawDefaults {
  static constexpr std::size_t kFromBlocks = kStrengths;
  enum { kTension, kCohesion, kTanPhi, kStrengthParams };  ///< the first parameters: Pa, Pa, -

  /// Joints that dilate by more than their friction angle would gain energy by sliding.
  static std::string Check(const double *property) {
    if (property[kStrengthDilation] <= property[kStrengthFriction]) return {};
    return "dilation (" + std::to_string(property[kStrengthDilation]) + " degrees) is above friction (" +
           std::to_string(property[kStrengthFriction]) +
           " degrees): sliding would gain energy; it must be at most the friction";
  }
  /// Cuts a tension above the tip of the Mohr-Coulomb cone, cohesion / tan(friction), to it.
  static std::string Adjust(double *property) {
    const double tan_phi = TanOfDegrees(property[kStrengthFriction]), c = property[kStrengthCohesion];
    double &tension = property[kStrengthTension];
    if (tension * tan_phi <= c) return {};
    tension = c / tan_phi;
    return "tension cut to cohesion / tan(friction) = " + std::to_string(tension) + " Pa";
  }
  static void MakeIntact(double *param) { param[kTension] = param[kCohesion] = kUnreached; }
  static void DeriveStrength(const double *property, double *param) {
    param[kTension] = property[kStrengthTension];
    param[kCohesion] = property[kStrengthCohesion];
    param[kTanPhi] = TanOfDegrees(property[kStrengthFriction]);
  }
  /// [out] tan(psi) and the slip at which it ends [m].
  static void DeriveDilation(const double *property, double *tan_psi, double *slip) {
    *tan_psi = TanOfDegrees(property[kStrengthDilation]);
    *slip = std::min(property[kStrengthDilationSlip], 1e30);  // products with it stay numbers
  }
};

}  // namespace cdem
