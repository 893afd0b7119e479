// One disc: its geometry, and how it is drawn at random from the seed, the set's name and its number.
#pragma once
#include <cstdint>
#include <string>

namespace cdem {

/// A flat circular joint.
struct Disc {
  double centre[3];   ///< m
  double normal[3];   ///< of length 1, pointing upward
  double radius;      ///< m
  double inside = 0;  ///< area inside the region of its set [m^2]
};

/// Law of the diameter D; p holds the parameters in the order of the options.
struct DiameterLaw {
  enum Kind { kFixed, kUniform, kLogNormal, kPower };
  Kind kind = kFixed;
  double p[3] = {0, 0, 0};  ///< fixed: d; uniform: min, max; lognormal: mean, sd of D; power: a, min, max [m]

  /// The largest D that is drawn [m]; a log-normal ln D is cut at kCut standard deviations.
  double Largest() const;
  double Mean() const;
  /// Mean of D^2 [m^2].
  double MeanSquare() const;
  static constexpr double kCut = 5;
};

/// What the discs of a set are drawn from.
struct JointLaw {
  double dip = 0, dip_direction = 0;  ///< degrees; direction clockwise from +y
  double fisher = -1;                 ///< kappa; below 0: all discs parallel
  DiameterLaw diameter;
};

/// Upward normal of a plane from dip and dip direction in degrees; exact where they are multiples of 90.
void NormalOf(double dip, double dip_direction, double normal[3]);
/// The reverse: dip from 0 to 90, direction from 0 to below 360 degrees.
void AnglesOf(const double normal[3], double *dip, double *dip_direction);
/// Two directions at right angles to normal and to each other.
void PlaneBasis(const double normal[3], double e0[3], double e1[3]);

/// Draws discs with centres uniform in a box. Disc n depends on seed, name, law, box and n alone.
class DiscSource {
 public:
  /// [in] lower, upper: bounding box of the region [m]; centres lie in it grown by the largest radius.
  DiscSource(const JointLaw &law, std::int64_t seed, const std::string &name, const double lower[3],
             const double upper[3]);
  /// Volume in which the centres lie [m^3].
  double Volume() const;
  /// Draws disc n; false (and half a disc) if its sphere does not reach the box.
  bool Draw(std::uint64_t n, Disc *disc) const;

 private:
  double Diameter(std::uint64_t n, double uniform) const;

  JointLaw law_;
  std::uint64_t seed_, stream_;
  double lower_[3], upper_[3], grow_, mean_[3], e_[2][3];
};

}  // namespace cdem
