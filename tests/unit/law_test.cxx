// Block and interface laws at a point, against closed forms and histories worked out by hand.
#include "forces/bodies.hpp"

#include <gtest/gtest.h>

namespace cdem {
namespace {

TEST(ElasticLaw, ClosedForms) {
  const double young = 7e9, nu = 0.2, property[] = {young, nu};
  double param[Elastic::kParams], s[6];
  Elastic::Derive(property, 1, param);
  const double e = 3e-4, bar = 1e-15 * young * e * 4;
  const double rod[6] = {e, -nu * e, -nu * e, 0, 0, 0};
  Elastic::Stress(param, rod, s);
  EXPECT_NEAR(s[kXX], young * e, bar);
  for (int i = 1; i < 6; ++i) EXPECT_NEAR(s[i], 0, bar);
  const double swelling[6] = {e, e, e, 0, 0, 0};
  Elastic::Stress(param, swelling, s);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(s[i], young / (1 - 2 * nu) * e, bar);
  const double column[6] = {0, 0, e, 0, 0, 0};
  Elastic::Stress(param, column, s);
  EXPECT_NEAR(s[kZZ], young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * e, bar);
  EXPECT_NEAR(s[kXX], nu / (1 - nu) * s[kZZ], bar);
  for (int i = 3; i < 6; ++i) {
    double shear[6] = {};
    shear[i] = e;  // half the engineering shear
    Elastic::Stress(param, shear, s);
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(s[j], i == j ? young / (1 + nu) * e : 0, bar);
  }
}

TEST(ElasticJoint, SplitsIntoNormalAndShear) {
  const double n[3] = {2. / 3, -1. / 3, 2. / 3}, d[3] = {1e-4, 3e-4, -2e-4}, kn = 5e9, ks = 2e9;
  double f[3];
  JointElastic::Force(n, kn, ks, d, f);
  const double along = Dot(n, d);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(f[k], -kn * along * n[k] - ks * (d[k] - along * n[k]), 1e-9);
}

/// One brittle spring of normal z and its history, through the bodies of the step. Powers of two keep sums exact.
struct Point {
  double kn = 1024, ks = 512, area = 0.5;
  double param[JointBrittle::kParams] = {16, 32, 0.5, 0};  ///< T = 8 N, C = 16 N, tan(phi) = 0.5
  std::uint8_t state = 0;
  double slip[3] = {0, 0, 0}, f[3] = {0, 0, 0};
  double Normal() const { return f[2]; }

  /// A committing evaluation; rate is beta (v_b - v_a).
  void Move(double x, double y, double z, double rate_x = 0, double rate_z = 0) {
    Spring<double> s = {{0, 0, 1}, kn, ks, area, {x, y, z}, {rate_x, 0, rate_z}, param, 0, 0, {}};
    s.tension_lost = state & kTensionLost ? 1 : 0;
    s.cohesion_lost = state & kCohesionLost ? 1 : 0;
    std::copy_n(slip, 3, s.history);
    const auto out =
        rate_x != 0 || rate_z != 0 ? SpringForce<JointBrittle, true>(s, f) : SpringForce<JointBrittle, false>(s, f);
    state = NextState(state, StateBits(out));
    std::copy_n(s.history, 3, slip);
  }
};
constexpr int kOpened = kTensionLost | kCohesionLost | kOpen, kBroken = kTensionLost | kCohesionLost;

TEST(BrittleJoint, TensionPeaksWithinOneIncrementAndDrops) {
  Point p;
  double peak = 0;
  const double step = 1. / 4096, increment = p.kn * step;  // T = 8 at d = 32 steps
  for (int i = 1; i <= 40; ++i) {
    p.Move(0, 0, i * step);
    EXPECT_EQ(p.Normal(), i < 32 ? -p.kn * i * step : 0);
    EXPECT_EQ(p.state, i < 32 ? 0 : kOpened);
    peak = std::max(peak, -p.Normal());
  }
  EXPECT_EQ(peak, 8 - increment);
}

TEST(BrittleJoint, ClosingAgainCarriesAndStartsWithoutShear) {
  Point p;
  p.Move(0, 0, 1);
  p.Move(0.25, -0.125, 0.5);  // moves sideways while open
  EXPECT_EQ(p.state, kOpened);
  EXPECT_EQ(p.slip[0], 0.25);
  EXPECT_EQ(p.slip[1], -0.125);
  p.Move(0.25, -0.125, -0.25);
  EXPECT_EQ(p.state, kBroken);
  EXPECT_EQ(p.Normal(), 256);
  EXPECT_EQ(p.f[0], 0);
  EXPECT_EQ(p.f[1], 0);
  p.Move(0.25 + 0.125, -0.125, -0.25);  // trial 64 below the cap 128: sticks
  EXPECT_EQ(p.f[0], -64);
  EXPECT_EQ(p.state, kBroken);
  p.Move(0.25 + 0.5, -0.125, -0.25);  // trial 256: rubs, without cohesion
  EXPECT_EQ(p.f[0], -128);
  EXPECT_EQ(p.state, kBroken | kSliding);
  EXPECT_EQ(p.slip[0], 0.75 - 128. / 512);
  p.Move(0.5, 0, 1e-9);  // lifts off at once: no tensile strength is left
  EXPECT_EQ(p.state, kOpened);
  EXPECT_EQ(p.Normal(), 0);
}

TEST(BrittleJoint, ShearPeakHasCohesionThenFrictionAlone) {
  Point p;
  p.Move(0, 0, -1. / 16);  // F_n = 64: cap 48, then 32
  p.Move(48. / 512, 0, -1. / 16);
  EXPECT_EQ(p.f[0], -48) << "at the cap it still sticks";
  EXPECT_EQ(p.state, 0);
  p.Move(50. / 512, 0, -1. / 16);
  EXPECT_EQ(p.f[0], -48);
  EXPECT_EQ(p.Normal(), 64);
  EXPECT_EQ(p.state, kBroken | kSliding);
  EXPECT_EQ(p.slip[0], 2. / 512) << "s = d_s + F_s / K_s";
  p.Move(50. / 512, 0, -1. / 16);
  EXPECT_EQ(p.f[0], -32);
  EXPECT_EQ(p.slip[0], 18. / 512);
  // unloading is elastic, and loads to the same cap the other way
  p.Move(40. / 512, 0, -1. / 16);
  EXPECT_EQ(p.f[0], -22);
  EXPECT_EQ(p.slip[0], 18. / 512);
  EXPECT_EQ(p.state, kBroken);
  p.Move(-20. / 512, 0, -1. / 16);
  EXPECT_EQ(p.f[0], 32);
  EXPECT_EQ(p.slip[0], 12. / 512);
}

TEST(BrittleJoint, ShearIsCappedInItsOwnDirection) {
  Point p;
  p.Move(0.3, 0.4, -1. / 16);  // |trial| = 256
  EXPECT_NEAR(p.f[0], -48 * 0.6, 1e-13);
  EXPECT_NEAR(p.f[1], -48 * 0.8, 1e-13);
  EXPECT_NEAR(p.slip[0], 0.3 - 48 * 0.6 / 512, 1e-15);
  EXPECT_NEAR(p.slip[1], 0.4 - 48 * 0.8 / 512, 1e-15);
  EXPECT_EQ(p.slip[2], 0);
}

TEST(BrittleJoint, TensionLowersTheCap) {
  Point p;
  p.Move(14. / 512, 0, 4. / 1024);  // F_n = -4: cap = 16 - 2
  EXPECT_EQ(p.state, 0);
  p.Move(15. / 512, 0, 4. / 1024);
  EXPECT_EQ(p.f[0], -14);
  EXPECT_EQ(p.Normal(), -4) << "in the step that shears it off";
  EXPECT_EQ(p.state, kBroken | kSliding);
  p.Move(15. / 512, 0, 4. / 1024);
  EXPECT_EQ(p.state, kOpened);
}

TEST(BrittleJoint, WithoutFrictionOnlyCohesionHolds) {
  Point p;
  p.param[JointBrittle::kTanPhi] = 0;
  p.Move(1, 0, -1);
  EXPECT_EQ(p.f[0], -16);
  p.Move(1, 0, -1);
  EXPECT_EQ(p.f[0], 0);
  EXPECT_EQ(p.slip[0], 1);
  EXPECT_EQ(p.Normal(), 1024);
}

TEST(BrittleJoint, WithoutStrengthItRestsIntact) {
  for (double tan_phi : {0.0, 0.5}) {
    Point p;
    p.param[JointBrittle::kTension] = p.param[JointBrittle::kCohesion] = 0;
    p.param[JointBrittle::kTanPhi] = tan_phi;
    p.Move(0, 0, 0);
    EXPECT_EQ(p.state, 0);
    p.Move(0, 0, -1);
    EXPECT_EQ(p.state, 0);
    EXPECT_EQ(p.Normal(), 1024);
    p.Move(0, 0, 1e-300);
    EXPECT_EQ(p.state, kOpened);
  }
}

TEST(BrittleJoint, TensionMayOutliveShear) {
  Point p;
  p.param[JointBrittle::kKeepTension] = 1;
  p.Move(50. / 512, 0, -1. / 16);
  EXPECT_EQ(p.state, kCohesionLost | kSliding);
  p.Move(p.slip[0], 0, 7. / 1024);
  EXPECT_EQ(p.Normal(), -7);
  p.Move(p.slip[0], 0, 8. / 1024);
  EXPECT_EQ(p.Normal(), 0);
  EXPECT_EQ(p.state, kOpened);
}

TEST(BrittleJoint, ViscousPart) {
  Point intact;
  intact.Move(1. / 512, 0, 1. / 1024, 1. / 512, 2. / 1024);
  EXPECT_EQ(intact.f[0], -2);
  EXPECT_EQ(intact.Normal(), -3) << "an intact spring pulls through it";
  Point open;
  open.Move(0, 0, 1, 1, 1);
  EXPECT_EQ(open.f[0], 0);
  EXPECT_EQ(open.Normal(), 0);
  Point crack;
  crack.Move(0, 0, 1);
  crack.Move(0, 0, -1. / 1024, 0, 3. / 1024);  // presses with 1, the dashpot pulls with 3
  EXPECT_EQ(crack.Normal(), 0);
  EXPECT_EQ(crack.state, kBroken);
  crack.Move(0, 0, -4. / 1024, 1. / 512, 3. / 1024);  // 4 - 3, and it sticks (cap 2)
  EXPECT_EQ(crack.Normal(), 1);
  EXPECT_EQ(crack.f[0], -1);
  crack.Move(1, 0, -4. / 1024, 1, -1. / 1024);  // slides: no tangential part
  EXPECT_EQ(crack.Normal(), 5);
  EXPECT_EQ(crack.f[0], -2);
}

}  // namespace
}  // namespace cdem
