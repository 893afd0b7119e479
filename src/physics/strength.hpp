// Properties that the block laws with strength share, and what is said about them.
#pragma once
#include "physics/law.hpp"

#include <cmath>
#include <cstdio>

namespace cdem {

inline constexpr double kDegree = 3.14159265358979323846 / 180;
inline constexpr double kNoTensionLimit = 1e30;  ///< Pa; a cut-off that nothing reaches

/// Strengths that an interface may take from the blocks beside it; the first properties of an interface law that has them.
enum { kStrengthTension, kStrengthCohesion, kStrengthFriction, kStrengths };
inline constexpr const char *kStrengthKeys[kStrengths] = {"tension", "cohesion", "friction"};

inline constexpr Property kCohesionProperty = {"cohesion", "Pa", 0, kPropertyInf, kPropertyClosed, "cohesion"};
inline constexpr Property kFrictionProperty = {"friction", "degrees", 0, 89.9, kPropertyClosed, "angle of friction"};
inline constexpr Property kDilationProperty = {
    "dilation", "degrees", 0, 89.9, kPropertyClosed, "angle of dilation, at most that of friction", 0};
inline constexpr Property kTensionProperty = {
    "tension",
    "Pa",
    0,
    kPropertyInf,
    kPropertyClosed,
    "uniaxial tensile strength; above the apex of the surface it is cut to it",
    kPropertyInf,
    "",
    "the apex"};
inline constexpr Property kResidualCohesionProperty = {
    "residual_cohesion", "Pa", 0, kPropertyInf, kPropertyClosed, "cohesion that is left in the end", 0};
inline constexpr Property kResidualFrictionProperty = {"residual_friction",
                                                       "degrees",
                                                       0,
                                                       89.9,
                                                       kPropertyClosed,
                                                       "angle of friction that is left in the end",
                                                       kPropertyInf,
                                                       "",
                                                       "that of friction"};

/// Tensile strength as it counts: not above the apex. [in] tension: infinite without a cut-off.
inline double TensionWithin(double tension, double apex) {
  return std::fmin(std::fmin(tension, apex), kNoTensionLimit);
}

/// Tip of Mohr-Coulomb's surface, c/tan(phi) [Pa]; infinite without friction.
inline double MohrCoulombApex(double cohesion, double friction) {
  return friction > 0 ? cohesion / std::tan(friction * kDegree) : kPropertyInf;
}

inline std::string TensionRemark(double tension, double apex) {
  if (std::isinf(tension) || tension <= apex) return {};
  char text[120];
  std::snprintf(text, sizeof text, "tension %g Pa lies above the apex of the surface: cut to it, %g Pa", tension, apex);
  return text;
}

/// Not above, or what is wrong.
inline std::string CheckNotAbove(const char *what, double value, const char *bound, double of) {
  if (value <= of) return {};
  char text[160];
  std::snprintf(text, sizeof text, "%s %g is above %s %g; give at most that", what, value, bound, of);
  return text;
}

inline std::string CheckDilation(double friction, double dilation) {
  return CheckNotAbove("dilation", dilation, "friction", friction);
}

}  // namespace cdem
