// What the brittle and the softening law have in common: a Mohr-Coulomb strength with dilation, given by the user.
#pragma once
#include "physics/law.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

/// The first properties of a law with strength, in this order.
enum { kStrengthTension, kStrengthCohesion, kStrengthFriction, kStrengthDilation, kStrengthDilationSlip };

inline constexpr Property kDilationProperties[] = {
    {"dilation", "degrees", 0, 89.9, kPropertyClosed, "angle of dilation: sliding opens the joint by its tangent", 0},
    {"dilation_slip", "m", 0, kPropertyInf, kPropertyOpen, "slip after which it dilates no more", kPropertyInf}};

inline double TanOfDegrees(double angle) { return std::tan(angle * (3.14159265358979323846 / 180)); }

/// Joints that dilate by more than their friction angle would gain energy by sliding.
inline std::string CheckDilation(const double *property) {
  if (property[kStrengthDilation] <= property[kStrengthFriction]) return {};
  return "dilation (" + std::to_string(property[kStrengthDilation]) + " degrees) is above friction (" +
         std::to_string(property[kStrengthFriction]) +
         " degrees): sliding would gain energy; it must be at most the friction";
}

/// Cuts a tension above the tip of the Mohr-Coulomb cone, cohesion / tan(friction), to it.
inline std::string CutTension(double *property) {
  const double tan_phi = TanOfDegrees(property[kStrengthFriction]), c = property[kStrengthCohesion];
  double &tension = property[kStrengthTension];
  if (tension * tan_phi <= c) return {};
  tension = c / tan_phi;
  return "tension cut to cohesion / tan(friction) = " + std::to_string(tension) + " Pa";
}

}  // namespace cdem
