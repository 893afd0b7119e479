// Dilation at a point, against closed forms: where a joint slides, shear and pressure are those of the path of its slip.
#include "joint_point.hpp"

namespace cdem {
namespace {

// Between plates that do not part: the peak, and from there on the line to which friction and pressure rise together.
TEST(DilatingJoint, ShearBetweenFixedPlates) {
  const double press = 1e6, z = -press / kKn, f = press * kArea * kTan, grip = kN * kTan * kTanPsi, limit = 3e-4;
  const double peak = (f + kCohesion) / kS;
  for (int steps : {1, 3, 700}) {
    Ride p(limit);
    p.Go(0, z, 1);
    p.Go(peak * (1 - 1e-9), z, 1);
    EXPECT_EQ(p.state, 0);
    EXPECT_NEAR(p.across, f + kCohesion, 2e-9 * kCohesion);
    // the step that breaks it still carries the cohesion
    const double over = 1e-5, slip = over * kS / (kS + grip);
    p.Go(peak + over, z, 1);
    EXPECT_NEAR(p.across, f + kCohesion + grip * slip, kBar * kCohesion);
    EXPECT_NEAR(-p.along, press * kArea + kN * kTanPsi * slip, kBar * kCohesion);
    EXPECT_NEAR(p.history[JointBrittleDilating::kGap], kTanPsi * slip, kBar * over);
    for (double x : {1e-3 * 0.7, 1e-3, 2e-3}) {  // before and after the end of the dilation
      p.Go(x, z, steps);
      double path = (kS * x - f) / (kS + grip);
      if (path > limit) path = (kS * x - f - grip * limit) / kS;
      const double rides = std::min(path, limit);
      EXPECT_NEAR(p.across, f + grip * rides, 1e-11 * kCohesion);
      EXPECT_NEAR(-p.along, press * kArea + kN * kTanPsi * rides, 1e-11 * kCohesion);
      EXPECT_NEAR(p.history[JointBrittleDilating::kPath], path, kBar * path);
      EXPECT_NEAR(p.history[JointBrittleDilating::kGap], kTanPsi * rides, kBar * path);
    }
    // an open crack keeps its dilation: it lies on its humps when it closes
    const double gap = p.history[JointBrittleDilating::kGap];
    p.Go(2e-3, 2 * gap, 1);
    EXPECT_EQ(p.along, 0);
    p.Go(2e-3, gap - 1e-5, 1);
    EXPECT_NEAR(-p.along, kN * 1e-5, 1e-10 * kN * 1e-5);
    EXPECT_EQ(p.across, 0);
  }
}

TEST(DilatingJoint, ACrackUnderNoPressureIsPushedOpen) {
  Ride p;
  p.state = kTensionLost | kCohesionLost;
  const double x = 1e-4, slip = kS * x / (kS + kN * kTan * kTanPsi);
  p.Go(x, 0, 1);
  EXPECT_NEAR(-p.along, kN * kTanPsi * slip, kBar * kN * x);
  EXPECT_NEAR(p.across, kN * kTanPsi * slip * kTan, kBar * kN * x);
  // just parted, nothing presses: a longer slip than there is shear to undo cannot be
  Ride q;
  q.state = kCohesionLost;
  q.param[JointBrittleDilating::kKeepTension] = 1;
  q.Go(1e-9, 0.9 * kFirst, 1);
  EXPECT_NEAR(q.across, 0, kBar * kCohesion);
  EXPECT_NEAR(q.history[JointBrittleDilating::kPath], 1e-9, 1e-20);
}

TEST(DilatingJoint, SofteningBetweenFixedPlates) {
  const double press = 1e6, z = -press / kKn, f = press * kArea * kTan, grip = kN * kTan * kTanPsi;
  for (double d0 : {0.0, 0.3})
    for (double limit : {0.1 * kSlipEnd, 0.2 * kSlipEnd, 0.7 * kSlipEnd, 1.5 * kSlipEnd})
      for (int steps : {1, 2, 7, 3000}) {
        // cap over slip, and so the shift at each slip: both known without a solver
        const auto cap = [&](double slip) {
          const double d = std::min(1.0, std::max(d0, slip / kSlipEnd));
          return f + grip * std::min(slip, limit) + (1 - d) * kCohesion;
        };
        for (int i = 1; i <= 16; ++i) {
          const double slip = 2.0 * kSlipEnd * i / 16, x = slip + cap(slip) / kS;
          SoftRide p(limit);
          if (d0 > 0) p.Go(0, kFirst + d0 * (kEnd - kFirst), 1);
          p.Go(0, z, 1);
          p.Go(x, z, steps);
          EXPECT_NEAR(p.across, cap(slip), 1e-11 * kCohesion);
          EXPECT_NEAR(p.history[JointSofteningDilating::kPath], slip, 1e-11 * slip);
          EXPECT_NEAR(p.history[JointSofteningDilating::kGap], kTanPsi * std::min(slip, limit), 1e-11 * slip);
          EXPECT_NEAR(-p.along, press * kArea + kN * kTanPsi * std::min(slip, limit), 1e-11 * kN * slip);
          EXPECT_NEAR(p.energy, 0.5 * (p.along * p.along / kN + p.across * p.across / kS), 1e-9 * p.energy);
        }
      }
}

TEST(DilatingJoint, AtMostTheFriction) {
  const double good[] = {0, 0, 30, 30, 1}, bad[] = {0, 0, 30, 31, 1};
  EXPECT_EQ(JointBrittle::Check(good), "");
  EXPECT_NE(JointBrittle::Check(bad).find("dilation"), std::string::npos);
}

}  // namespace
}  // namespace cdem
