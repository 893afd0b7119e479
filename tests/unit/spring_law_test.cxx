// The law of discrete springs at a point, against closed forms.
#include "forces/bodies.hpp"

#include <gtest/gtest.h>
#include <random>

namespace cdem {
namespace {

constexpr double kBar = 1e-12;

/// One corner: its faces stand on the columns of a basis, whose lengths are those of no unit vectors.
struct Corner {
  double area[3][3] = {{2, 0, 0}, {0, 0.5, 0}, {0, 0, 3}};
  double param[SpringBlock::kParams], state[1] = {0}, s[6];
  double young = 1e9, poisson = 0.25;

  explicit Corner(double tension = 1e6, double cohesion = 2e6, double friction = 30, double residual = kPropertyInf) {
    const double property[] = {young, poisson, tension, cohesion, friction, residual};
    SpringBlock::Derive(property, 1, param);
  }
  /// Strain whose elastic stress is that given.
  void Strain(const double stress[6], double e[6]) const {
    const double trace = stress[kXX] + stress[kYY] + stress[kZZ], two_mu = young / (1 + poisson);
    for (int i = 0; i < 6; ++i) e[i] = (stress[i] - (i < 3 ? poisson / (1 + poisson) * trace : 0)) / two_mu;
  }
  /// Returns whether something broke.
  bool Load(const double stress[6]) {
    double e[6];
    Strain(stress, e);
    return SpringBlock::Stress(param, e, area, state, s);
  }
  bool Load(double xx, double yy, double zz, double xy = 0, double yz = 0, double xz = 0) {
    const double stress[6] = {xx, yy, zz, xy, yz, xz};
    return Load(stress);
  }
  void Expect(double xx, double yy, double zz, double xy, double yz, double xz, double size) const {
    const double exact[6] = {xx, yy, zz, xy, yz, xz};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(s[i], exact[i], kBar * size) << i;
  }
};

TEST(SpringLaw, BreaksInTensionAtItsStrength) {
  Corner c;
  EXPECT_FALSE(c.Load(1e6 * (1 - kBar), 0, 0));
  c.Expect(1e6 * (1 - kBar), 0, 0, 0, 0, 0, 1e6);
  EXPECT_EQ(c.state[0], 0);
  EXPECT_TRUE(c.Load(1e6 * (1 + kBar), -2e5, 3e5, 1e5, 5e4, 0));
  EXPECT_EQ(c.state[0], 1);
  c.Expect(0, -2e5, 3e5, 0, 5e4, 0, 1e6);
  EXPECT_FALSE(c.Load(-4e5, -2e5, 3e5, 1e5, 5e4, 0)) << "closed again, below friction";
  c.Expect(-4e5, -2e5, 3e5, 1e5, 5e4, 0, 1e6);
  EXPECT_FALSE(c.Load(-1e5, -2e5, 3e5, 1e5, 5e4, 0)) << "it slides";
  c.Expect(-1e5, -2e5, 3e5, 1e5 * std::tan(std::acos(-1) / 6), 5e4, 0, 1e6);
  EXPECT_EQ(c.state[0], 1);
}

TEST(SpringLaw, BreaksInShearAtMohrCoulombsStrength) {
  const double n = 3e6, peak = 2e6 + n * std::tan(std::acos(-1) / 6), residual = n * std::tan(std::acos(-1) / 9);
  for (int face = 0; face < 3; ++face) {
    // compression of the face alone; its shear acts on the neighbour too, which is stronger where it is pressed more
    double stress[6] = {-3 * n, -3 * n, -3 * n, 0, 0, 0};
    const int shear[3] = {kXY, kYZ, kXZ};
    stress[face] = -n;
    Corner c(1e6, 2e6, 30, 20);
    stress[shear[face]] = peak * (1 - kBar);
    EXPECT_FALSE(c.Load(stress));
    stress[shear[face]] = -peak * (1 + kBar);
    EXPECT_TRUE(c.Load(stress));
    EXPECT_EQ(c.state[0], face == 0 ? 1 : face == 1 ? 2 : 4);
    EXPECT_NEAR(c.s[shear[face]], -residual, kBar * n);
    EXPECT_NEAR(c.s[face], -n, kBar * n);
  }
}

TEST(SpringLaw, TractionsOnObliqueFacesAreCapped) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> entry(-1, 1);
  int seen[2] = {0, 0};
  for (int round = 0; round < 500; ++round) {
    Corner c(0, 0, 25, 15);
    for (auto &row : c.area)
      for (double &value : row) value += 0.4 * entry(random);
    double stress[6], t[3], before[3];
    for (int i = 0; i < 6; ++i) stress[i] = 1e6 * entry(random) - (i < 3 ? 1e6 : 0);
    c.state[0] = 1;  // the first face is broken, the others may break
    c.param[SpringBlock::kTension] = c.param[SpringBlock::kCohesion] = 1e9;
    ASSERT_FALSE(c.Load(stress));
    const double size = std::sqrt(Dot(c.area[0], c.area[0]));
    double n[3], normal = 0, after = 0, shear[3], shear_after[3];
    for (int k = 0; k < 3; ++k) n[k] = c.area[0][k] / size;
    Apply(stress, n, before);
    Apply(c.s, n, t);
    normal = Dot(n, before), after = Dot(n, t);
    for (int k = 0; k < 3; ++k) shear[k] = before[k] - normal * n[k], shear_after[k] = t[k] - after * n[k];
    const double was = std::sqrt(Dot(shear, shear)), cap = -std::min(normal, 0.0) * std::tan(std::acos(-1) / 12);
    EXPECT_NEAR(after, std::min(normal, 0.0), kBar * 1e6);
    ++seen[was > cap];
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(shear_after[k], was > cap ? shear[k] * cap / was : shear[k], kBar * 1e6);
    // directions within the face feel nothing of it
    double p[3] = {n[1], -n[0], 0}, q[3];
    Cross(n, p, q);
    for (const double *a : {p, q})
      for (const double *b : {p, q}) {
        double old_side[3], new_side[3];
        Apply(stress, b, old_side);
        Apply(c.s, b, new_side);
        EXPECT_NEAR(Dot(a, new_side), Dot(a, old_side), kBar * 1e6);
      }
  }
  EXPECT_GT(seen[0], 10);
  EXPECT_GT(seen[1], 100);
}

TEST(SpringLaw, AllThreeFacesBrokenCarryPressureOnly) {
  Corner c(0, 0, 0);
  c.state[0] = 7;
  EXPECT_FALSE(c.Load(-1e6, -2e6, 3e6, 4e5, 5e5, 6e5));
  c.Expect(-1e6, -2e6, 0, 0, 0, 0, 1e6);
  EXPECT_EQ(c.state[0], 7);
}

TEST(SpringLaw, RestsIntactWithoutStrength) {
  Corner c(0, 0, 30);
  EXPECT_FALSE(c.Load(0, 0, 0));
  EXPECT_FALSE(c.Load(-1e6, -1e6, -1e6));
  EXPECT_TRUE(c.Load(1, -1e6, -1e6));
  EXPECT_EQ(c.state[0], 1);
}

// What is broken has let go when the others are judged: the shear of a crack that slid does not break its neighbour.
TEST(SpringLaw, ReleasedShearBreaksNoNeighbour) {
  Corner c(1e9, 1e6, 0, 0);
  c.param[SpringBlock::kTanPhi] = 0.1;
  EXPECT_TRUE(c.Load(0, -1e6, 0, 1.05e6));
  EXPECT_EQ(c.state[0], 1);
  EXPECT_FALSE(c.Load(0, -1e6, 0, 5e6));
  EXPECT_EQ(c.state[0], 1);
  c.Expect(0, -1e6, 0, 0, 0, 0, 5e6);
}

}  // namespace
}  // namespace cdem
