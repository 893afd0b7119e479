// Softening at a point, against closed forms. A closed form knows no increments, so the same path in one step and in
// thousands must give the same.
#include "joint_point.hpp"

#include <random>

namespace cdem {
namespace {

/// Pull at an opening that was never larger.
double Envelope(double z) { return z <= kFirst ? kN * z : z >= kEnd ? 0 : kT * (kEnd - z) / (kEnd - kFirst); }

TEST(SofteningJoint, TensionFollowsTheTriangle) {
  Soft p;
  double area = 0, before = 0;
  const int steps = 4500;
  for (int i = 1; i <= steps; ++i) {
    const double z = 1.02 * kEnd * i / steps;
    p.Move(0, z);
    EXPECT_NEAR(p.along, Envelope(z), kBar * kT);
    EXPECT_NEAR(p.across, 0, kBar * kT);
    EXPECT_NEAR(p.energy, 0.5 * p.along * z, kBar * kT * z);
    EXPECT_EQ(p.state, z <= kFirst ? 0 : z < kEnd ? kDamaged : (kDamaged | kTensionLost | kCohesionLost | kOpen));
    area += 0.5 * (p.along + before) * 1.02 * kEnd / steps;
    before = p.along;
  }
  EXPECT_EQ(p.along, 0);
  EXPECT_NEAR(area, kGI * kArea, 1e-3 * kGI * kArea);
  std::printf("    area in tension: %.1e from G_I\n", area / (kGI * kArea) - 1);
}

// With both corners of the triangle on the grid, trapezoids have no error of their own.
TEST(SofteningJoint, TensionTakesGIExactly) {
  Soft p;
  double area = 0, z = 0;
  for (int leg = 0; leg < 2; ++leg)
    for (int i = 1; i <= 50; ++i) {
      const double next = leg == 0 ? kFirst * i / 50 : kFirst + (kEnd - kFirst) * i / 50, before = p.along;
      p.Move(0, next);
      area += 0.5 * (p.along + before) * (next - z);
      z = next;
    }
  EXPECT_NEAR(area, kGI * kArea, kBar * kGI * kArea);
}

TEST(SofteningJoint, TensionUnloadsToTheOrigin) {
  for (int steps : {1, 7, 300})
    for (double share : {0.01, 0.3, 0.9}) {
      Soft p;
      const double z = kFirst + share * (kEnd - kFirst), peak = Envelope(z);
      p.Go(0, z, steps);
      EXPECT_NEAR(p.damage(), share, kBar);
      EXPECT_NEAR(p.along, peak, kBar * kT);
      for (double back : {0.8, 0.5, 0.1, 0.4, 0.99}) {
        p.Go(0, back * z, steps);
        EXPECT_NEAR(p.along, back * peak, kBar * kT);
        EXPECT_NEAR(p.energy, 0.5 * back * peak * back * z, kBar * kT * z);
        EXPECT_NEAR(p.damage(), share, kBar);
      }
      p.Go(0, -0.3 * z, steps);
      EXPECT_NEAR(p.along, -kN * 0.3 * z, kBar * kN * z) << "a damaged spring presses with all of K_n";
      EXPECT_EQ(p.state, kDamaged);
      p.Go(0, z, steps);
      EXPECT_NEAR(p.along, peak, kBar * kT);
      p.Go(0, 0.5 * (z + kEnd), steps);
      EXPECT_NEAR(p.along, Envelope(0.5 * (z + kEnd)), kBar * kT);
      p.Go(0, 1.1 * kEnd, steps);
      EXPECT_EQ(p.along, 0);
      p.Go(0, 1e-9 * kEnd, steps);
      EXPECT_EQ(p.along, 0);
      p.Go(0, -z, steps);
      EXPECT_NEAR(p.along, -kN * z, kBar * kN * z);
    }
}

/// What resists a shift x that only grew, with friction f [N], damage d0 from an opening before; the slip is *slip.
double ShearEnvelope(double x, double f, double d0 = 0, double *slip = nullptr) {
  const double at_cap = (f + (1 - d0) * kCohesion) / kS, flat = at_cap + d0 * kSlipEnd;  // slip does not drive D yet
  double s = 0;
  if (x <= at_cap)
    s = 0;
  else if (x <= flat)
    s = x - at_cap;
  else
    s = std::min(kSlipEnd, d0 * kSlipEnd + (x - flat) / (1 - kCohesion / (kS * kSlipEnd)));
  if (s >= kSlipEnd) s = x - f / kS;
  if (slip) *slip = s;
  return kS * (x - s);
}

TEST(SofteningJoint, ShearFallsToTheResidual) {
  for (double press : {0.0, 1e6})
    for (int steps : {1, 2, 3, 10, 2000}) {
      const double f = press * kArea * kTan, z = -press / kKn, far = 1.3 * kSlipEnd + f / kS;
      for (int i = 1; i <= 40; ++i) {  // to each of 40 shifts, from the start, in so many steps
        Soft p;
        p.Go(0, z, 1);
        const double x = far * i / 40;
        double slip;
        const double exact = ShearEnvelope(x, f, 0, &slip);
        p.Go(x, z, steps);
        EXPECT_NEAR(p.across, exact, kBar * (kCohesion + f));
        EXPECT_NEAR(p.along, -press * kArea, kBar * (press + 1));
        EXPECT_NEAR(p.history[JointSoftening::kPath], slip, kBar * far);
        EXPECT_NEAR(p.damage(), std::min(1.0, slip / kSlipEnd), 1e-11);
        EXPECT_EQ((p.state & kCohesionLost) != 0, slip >= kSlipEnd);
        EXPECT_NEAR(p.energy, 0.5 * exact * exact / kS + 0.5 * kN * z * z, kBar * (kCohesion + f) * far);
      }
    }
}

TEST(SofteningJoint, ShearTakesGIIAboveFriction) {
  for (double press : {0.0, 1e6}) {
    Soft p;
    const double f = press * kArea * kTan, z = -press / kKn, peak = (kCohesion + f) / kS, last = kSlipEnd + f / kS;
    p.Go(peak, z, 1);
    double area = 0, rough = 0, before = kCohesion, slip = 0;
    const int steps = 100;  // corners on the grid: exact; off it: 0.1 %
    for (int i = 1; i <= steps; ++i) {
      p.Move(peak + (last - peak) * i / steps, z);
      const double now = p.history[JointSoftening::kPath];
      area += 0.5 * (p.across - f + before) * (now - slip);
      before = p.across - f, slip = now;
    }
    EXPECT_NEAR(area, kGII * kArea, 1e-11 * kGII * kArea);
    Soft q;
    q.Go(0, z, 1);
    before = slip = 0;
    for (int i = 1; i <= 3000; ++i) {
      q.Move(1.1 * last * i / 3000, z);
      const double now = q.history[JointSoftening::kPath];
      rough += 0.5 * (q.across - f + before) * (now - slip);
      before = q.across - f, slip = now;
    }
    EXPECT_NEAR(rough, kGII * kArea, 1e-3 * kGII * kArea);
    std::printf("    area in shear: %.1e from G_II\n", rough / (kGII * kArea) - 1);
  }
}

TEST(SofteningJoint, ShearUnloadsElastically) {
  const double press = 1e6, f = press * kArea * kTan, z = -press / kKn, x = 0.4 * kSlipEnd;
  double slip;
  const double force = ShearEnvelope(x, f, 0, &slip);
  for (int steps : {1, 50}) {
    Soft p;
    p.Go(0, z, 1);
    p.Go(x, z, steps);
    const double back = 1.5 * force / kS;  // not yet the cap the other way
    p.Go(x - back, z, steps);
    EXPECT_NEAR(p.across, force - kS * back, kBar * kCohesion);
    EXPECT_EQ(p.state, kDamaged);
    p.Go(x, z, steps);
    EXPECT_NEAR(p.across, force, kBar * kCohesion);
    // sliding back makes the path longer: the cap falls on
    const double more = 0.2 * kSlipEnd, cap = f + (1 - (slip + more) / kSlipEnd) * kCohesion;
    p.Go(x - force / kS - cap / kS - more, z, steps);
    EXPECT_NEAR(p.across, -cap, 1e-11 * kCohesion);
    EXPECT_NEAR(p.history[JointSoftening::kPath], slip + more, kBar);
  }
}

TEST(SofteningJoint, OneDamageForBoth) {
  for (int steps : {1, 4, 1000})
    for (double d0 : {0.2, 0.7}) {
      // pulled first, then sheared under pressure: the cap waits until the slip has caught up
      const double opened = kFirst + d0 * (kEnd - kFirst), press = 5e5, f = press * kArea * kTan;
      for (int i = 1; i <= 30; ++i) {
        Soft p;
        p.Go(0, opened, steps);
        p.Go(0, -press / kKn, steps);
        const double x = 1.5 * kSlipEnd * i / 30;
        p.Go(x, -press / kKn, steps);
        EXPECT_NEAR(p.across, ShearEnvelope(x, f, d0), 1e-11 * kCohesion);
      }
      // sheared first: the tension that is left
      Soft p;
      p.Go(kCohesion / kS + d0 * kSlipEnd * (1 - kCohesion / (kS * kSlipEnd)), 0, steps);
      EXPECT_NEAR(p.damage(), d0, 1e-11);
      p.Go(p.history[JointSoftening::kSlip + 1], 0, steps);
      p.Go(p.x_, 0.5 * opened, steps);
      EXPECT_NEAR(p.along, 0.5 * (1 - d0) * kT, 1e-11 * kT);
      p.Go(p.x_, 0.5 * (opened + kEnd), steps);
      EXPECT_NEAR(p.along, Envelope(0.5 * (opened + kEnd)), 1e-11 * kT);
    }
}

// Under a constant opening the tension falls as the slip damages: one step must find what thousands find.
TEST(SofteningJoint, ShearUnderTension) {
  for (double share : {0.3, 1.0, 5.0, 10.0}) {
    const double z = share * kFirst, d0 = std::max(0.0, (z - kFirst) / (kEnd - kFirst));
    for (int i = 1; i <= 20; ++i) {
      const double x = 1.2 * kSlipEnd * i / 20;
      Soft once, often;
      once.Go(0, z, 1), often.Go(0, z, 1);
      once.Go(x, z, 1), often.Go(x, z, 5000);
      const double d = once.damage(), slip = once.history[JointSoftening::kPath];
      EXPECT_NEAR(once.across, often.across, 1e-11 * kCohesion);
      EXPECT_NEAR(once.along, often.along, 1e-11 * kT);
      EXPECT_NEAR(d, often.damage(), 1e-11);
      EXPECT_NEAR(once.along, (1 - d) * kT * z / (kFirst + d * (kEnd - kFirst)), kBar * kT);
      const double cap = (1 - d) * kCohesion - once.along * kTan;
      EXPECT_LE(once.across, cap + kBar * kCohesion);
      if (slip > 0 && d < 1) {
        EXPECT_NEAR(once.across, cap, kBar * kCohesion);
      }
      EXPECT_NEAR(d, std::min(1.0, std::max(d0, slip / kSlipEnd)), 1e-11);
      EXPECT_NEAR(once.across, kS * (x - slip), kBar * kCohesion);
      if (d >= 1) {
        EXPECT_EQ(once.state & ~kDamaged, kTensionLost | kCohesionLost | kOpen);
      }
    }
  }
}

TEST(SofteningJoint, BrokenFromTheStartRubs) {
  Soft p;
  p.state = kTensionLost | kCohesionLost;
  p.Move(0, 0.5 * kFirst);
  EXPECT_EQ(p.along, 0);
  EXPECT_EQ(p.state & kOpen, kOpen);
  Soft q;
  q.state = kTensionLost | kCohesionLost;
  const double press = 1e6;
  q.Move(1, -press / kKn);
  EXPECT_NEAR(q.across, press * kArea * kTan, kBar * kCohesion);
  EXPECT_NEAR(q.along, -press * kArea, kBar * kCohesion);
}

TEST(SofteningJoint, ViscousPart) {
  Soft intact;
  intact.Move(1e-6, 0.5 * kFirst, 2e-6, 0.1 * kFirst);
  EXPECT_NEAR(intact.along, 0.6 * kT, kBar * kT);
  EXPECT_NEAR(intact.across, 3e-6 * kS, kBar * kT);
  Soft half;
  half.Go(0, kFirst + 0.5 * (kEnd - kFirst), 1);
  const double secant = half.along / half.z_;
  half.Move(0, 0.5 * half.z_, 0, 0.1 * half.z_);
  EXPECT_NEAR(half.along, secant * 0.6 * half.z_, kBar * kT) << "by the stiffness to the origin";
  Soft broken;
  broken.Move(0, 2 * kEnd);
  broken.Move(0, 1.5 * kEnd, 1, 1);
  EXPECT_EQ(broken.along, 0);
  EXPECT_EQ(broken.across, 0);
  broken.Move(0, -kFirst, 0, 2 * kFirst);
  EXPECT_NEAR(broken.along, 0, kBar * kT) << "presses with 1, the dashpot pulls with 2";
}

TEST(SofteningJoint, RandomPathsStayWithinTheirStrength) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int path = 0; path < 500; ++path) {
    SoftRide p(2e-5);
    double damage = 0;
    for (int step = 0; step < 60; ++step) {
      p.Move(entry(random) * kSlipEnd * 0.1, entry(random) * (path % 2 ? kEnd * 0.7 : 5 * kFirst));
      const double d = std::max(p.damage(), damage);
      EXPECT_GE(p.damage(), damage);
      EXPECT_LE(p.damage(), 1);
      damage = d;
      EXPECT_LE(p.along, (1 - d) * kT * (1 + 1e-11));
      EXPECT_LE(std::fabs(p.across), std::max(0.0, (1 - d) * kCohesion - p.along * kTan) + 1e-11 * (kCohesion + kT));
      EXPECT_GE(p.energy, 0);
    }
  }
}

TEST(SofteningJoint, NeedsAFallLongerThanTheRise) {
  const double most_t = std::sqrt(2 * kGI * kKn), most_c = std::sqrt(2 * kGII * kKs);
  double property[] = {0.999 * most_t, 0.999 * most_c, 30, 0, 1, kGI, kGII};
  EXPECT_EQ(JointSoftening::CheckFace(property, kKn, kKs), "");
  property[0] = most_t;
  EXPECT_NE(JointSoftening::CheckFace(property, kKn, kKs).find("tension"), std::string::npos);
  property[0] = 1;
  property[1] = 1.1 * most_c;
  const std::string text = JointSoftening::CheckFace(property, kKn, kKs);
  char number[30];
  std::snprintf(number, sizeof number, "%g Pa", most_c);
  for (const std::string word : {"cohesion", "gii", static_cast<const char *>(number)})
    EXPECT_NE(text.find(word), std::string::npos) << text;
  double cut[] = {5e6, 1e6, 45, 0, 1, kGI, kGII};
  EXPECT_NE(JointSoftening::Adjust(cut), "");
  EXPECT_NEAR(cut[0], 1e6, 1e-6);
  EXPECT_EQ(JointSoftening::Adjust(cut), "");
  EXPECT_EQ(JointSoftening::LargestCell(cut, 5e10), 5e10 * kGI / (cut[0] * cut[0]) / 5);
}

}  // namespace
}  // namespace cdem
