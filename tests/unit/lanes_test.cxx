// Interface laws in lanes and on one double: the same to the last bit, along random paths that break the springs.
#include "forces/bodies.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace cdem {
namespace {

template <class Law, bool kBeta>
void ExpectLanesEqualDouble(const double *property) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> entry(-1, 1);
  double row[kMaxParams] = {};
  Law::Derive(property, row);
  Lanes param[kMaxParams];
  for (int p = 0; p < Law::kParams; ++p) param[p] = Lanes{} + row[p];
  int open = 0, slides = 0, damaged = 0, broken = 0, intact = 0;
  for (int path = 0; path < 300; ++path) {
    Spring<Lanes> s{};
    Spring<double> one[kLanes] = {};
    std::uint8_t state[kLanes] = {};
    double velocity[kLanes][3];
    for (int l = 0; l < kLanes; ++l) {
      double m[3] = {entry(random), entry(random), entry(random)};
      const double size = std::sqrt(Dot(m, m));
      for (int k = 0; k < 3; ++k) one[l].normal[k] = m[k] / size, velocity[l][k] = 0.05 * entry(random);
      one[l].area = 1.5 + entry(random);
      one[l].kn = one[l].area * (20 + entry(random));
      one[l].ks = one[l].area * (15 + entry(random));
      one[l].param = row;
      if (path % 7 == 0) state[l] = kTensionLost | kCohesionLost;
    }
    for (int step = 0; step < 40; ++step) {
      for (int l = 0; l < kLanes; ++l) {
        if (step % 10 == 9)
          for (double &v : velocity[l]) v = 0.1 * entry(random);
        one[l].tension_lost = state[l] & kTensionLost ? 1 : 0;
        one[l].cohesion_lost = state[l] & kCohesionLost ? 1 : 0;
        for (int k = 0; k < 3; ++k) {
          one[l].d[k] += velocity[l][k];
          one[l].beta_rate[k] = 0.1 * entry(random);
          s.normal[k][l] = one[l].normal[k], s.d[k][l] = one[l].d[k], s.beta_rate[k][l] = one[l].beta_rate[k];
        }
        s.kn[l] = one[l].kn, s.ks[l] = one[l].ks, s.area[l] = one[l].area;
        s.tension_lost[l] = one[l].tension_lost, s.cohesion_lost[l] = one[l].cohesion_lost;
      }
      s.param = param;
      Lanes f[3];
      const Outcome<Lanes> out = SpringForce<Law, kBeta>(s, f);
      const LaneMask bits = StateBits(out);
      for (int l = 0; l < kLanes; ++l) {
        double f1[3];
        const Spring<double> before = one[l];
        const Outcome<double> out1 = SpringForce<Law, kBeta>(one[l], f1);
        ASSERT_TRUE(out1.changed || std::memcmp(one[l].history, before.history, sizeof before.history) == 0);
        ASSERT_EQ(StateBits(out1), bits[l]);
        state[l] = NextState(state[l], bits[l]);
        for (int k = 0; k < 3; ++k) {
          const double of_lanes = f[k][l];
          ASSERT_EQ(std::memcmp(&of_lanes, &f1[k], sizeof of_lanes), 0) << of_lanes - f1[k];
        }
        for (int k = 0; k < Law::kState; ++k) {
          const double of_lanes = s.history[k][l];
          ASSERT_EQ(std::memcmp(&of_lanes, &one[l].history[k], sizeof of_lanes), 0) << k << ": " << of_lanes;
        }
        ASSERT_TRUE(std::isfinite(f1[0] + f1[1] + f1[2]));
        open += (state[l] & kOpen) != 0;
        slides += (state[l] & kSliding) != 0;
        broken += (state[l] & kCohesionLost) != 0;
        damaged += (state[l] & (kDamaged | kCohesionLost)) == kDamaged;
        intact += state[l] == 0;
      }
    }
  }
  for (int count : {open, slides, broken, intact}) EXPECT_GT(count, 100);
  EXPECT_GE(damaged, std::strcmp(Law::kName, "softening") == 0 ? 100 : 0);
}

TEST(LanesEqualDouble, InEveryInterfaceLaw) {
  const double brittle[] = {2, 3, 35, 0, 1}, rides[] = {2, 3, 35, 12, 0.4};
  const double softens[] = {2, 3, 35, 0, 1, 0.3, 0.6}, both[] = {2, 3, 35, 12, 0.1, 0.3, 0.6};
  ExpectLanesEqualDouble<JointBrittle, false>(brittle);
  ExpectLanesEqualDouble<JointBrittle, true>(brittle);
  ExpectLanesEqualDouble<JointBrittleDilating, false>(rides);
  ExpectLanesEqualDouble<JointBrittleDilating, true>(rides);
  ExpectLanesEqualDouble<JointSoftening, false>(softens);
  ExpectLanesEqualDouble<JointSoftening, true>(softens);
  ExpectLanesEqualDouble<JointSofteningDilating, false>(both);
  ExpectLanesEqualDouble<JointSofteningDilating, true>(both);
}

}  // namespace
}  // namespace cdem
