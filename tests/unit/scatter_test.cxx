// Scattered values: their distributions by Kolmogorov and Smirnov's test, their independence of the partition.
#include "physics/scatter.hpp"

#include "forces/params.hpp"
#include "physics/laws.hpp"
#include "small_body.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace cdem {
namespace {

const Property kStrength{"cohesion", "Pa", 0, kPropertyInf, kPropertyClosed};

std::vector<double> Sample(const Scatter &scatter, int n, std::int64_t seed = 7) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(ScatteredValue(scatter, kStrength, 2e6, 1, seed, i));
  std::sort(values.begin(), values.end());
  return values;
}

/// p-value of the Kolmogorov-Smirnov statistic of a sorted sample against a distribution function.
template <class F>
double PValue(const std::vector<double> &sorted, F &&cdf) {
  double d = 0;
  const double n = static_cast<double>(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double f = cdf(sorted[i]);
    d = std::max({d, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
  }
  const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * d;
  double p = 0;
  for (int k = 1; k < 100; ++k) p += (k % 2 ? 2 : -2) * std::exp(-2.0 * k * k * x * x);
  return p;
}

TEST(Scatter, Distributions) {
  const double mean = 2e6;
  const int n = 20000;
  EXPECT_GT(PValue(Sample({Scatter::kWeibull, 3}, n),
                   [&](double x) { return 1 - std::exp(-std::pow(x / mean * std::tgamma(1 + 1. / 3), 3)); }),
            0.01);
  EXPECT_GT(PValue(Sample({Scatter::kNormal, 0.2}, n),
                   [&](double x) { return 0.5 * std::erfc((1 - x / mean) / (0.2 * std::sqrt(2.0))); }),
            0.01);
  EXPECT_GT(PValue(Sample({Scatter::kUniform, 0.5}, n), [&](double x) { return x / mean - 0.5; }), 0.01);
  // a test that can fail: the wrong modulus is refused
  EXPECT_LT(PValue(Sample({Scatter::kWeibull, 3.2}, n),
                   [&](double x) { return 1 - std::exp(-std::pow(x / mean * std::tgamma(1 + 1. / 3), 3)); }),
            0.01);
}

TEST(Scatter, WeibullKeepsItsMean) {
  double sum = 0;
  const std::vector<double> values = Sample({Scatter::kWeibull, 2}, 40000);
  for (double value : values) sum += value;
  // standard deviation 0.52 of the mean, over 200
  EXPECT_NEAR(sum / 40000, 2e6, 4 * 0.523 / 200 * 2e6);
}

TEST(Scatter, IsAFunctionOfSeedKeyAndNumber) {
  const Scatter s{Scatter::kUniform, 0.5};
  const Property other{"tension", "Pa", 0, kPropertyInf, kPropertyClosed};
  const double a = ScatteredValue(s, kStrength, 1, 1, 7, 11);
  EXPECT_EQ(a, ScatteredValue(s, kStrength, 1, 1, 7, 11));
  EXPECT_NE(a, ScatteredValue(s, kStrength, 1, 1, 8, 11));
  EXPECT_NE(a, ScatteredValue(s, kStrength, 1, 1, 7, 12));
  EXPECT_NE(a, ScatteredValue(s, other, 1, 1, 7, 11));
}

TEST(Scatter, NeverLeavesTheRange) {
  const Scatter wide{Scatter::kNormal, 2};
  const Property angle{"friction", "degrees", 0, 89.9, kPropertyClosed},
      modulus{"young", "Pa", 0, kPropertyInf, kPropertyOpen};
  int cut = 0;
  for (int i = 0; i < 1000; ++i) {
    const double friction = ScatteredValue(wide, angle, 40, 1, 1, i),
                 young = ScatteredValue(wide, modulus, 1e9, 1, 1, i);
    EXPECT_GE(friction, 0);
    EXPECT_LE(friction, 89.9);
    EXPECT_GE(young, 1e6);
    cut += friction == 0;
  }
  EXPECT_GT(cut, 0);
}

TEST(Scatter, SizeEffectOfWeibull) {
  Body body;
  body.Make("-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1");
  body.Move([](double x[3]) { x[0] = x[0] > 1.5 ? 9 : x[0]; });  // the second cell has 8 times the volume
  Material &m = body.materials[0];
  m.property[0] = 1e10;
  m.property[1] = 0.25;
  m.scatter.of[0] = {Scatter::kWeibull, 3};
  m.scatter.any = true;
  double plain[2][kMaxParams], sized[2][kMaxParams];
  for (PetscInt c = 0; c < 2; ++c) CellParams(body.mesh, body.materials, c, plain[c]);
  m.scatter.volume = 1;
  for (PetscInt c = 0; c < 2; ++c) CellParams(body.mesh, body.materials, c, sized[c]);
  const double volume[2] = {1, 8};
  for (int c = 0; c < 2; ++c) EXPECT_NEAR(sized[c][1] / plain[c][1], std::pow(volume[c], -1. / 3), 1e-12);
  EXPECT_NE(plain[0][1], plain[1][1]);
}

TEST(Scatter, OfFacesIsThatOfTheirSprings) {
  const std::string scene =
      "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3 -ts_max_steps 1 -interfaces j "
      "-interface_j_on all -interface_j_law brittle -interface_j_tension 1e5 "
      "-interface_j_cohesion 2e5 -interface_j_friction 30 -interface_j_cohesion_scatter uniform:0.5 "
      "-interface_j_kn_scatter normal:0.1 -interface_j_tension_scatter weibull:3";
  std::unique_ptr<Simulation> s = SetUpScene(scene + kRock);
  ASSERT_NE(s, nullptr);
  const SpringTable &t = s->tables().springs[0];
  std::vector<double> cohesions;
  for (int i = 0; i < t.n; ++i) {
    const double *param = &s->tables().joint_param[static_cast<std::size_t>(kMaxParams) * t.joint[i]];
    EXPECT_GE(param[JointBrittle::kCohesion], 1e5);
    EXPECT_LE(param[JointBrittle::kCohesion], 3e5);
    // a tension above the tip of the cone is cut face by face
    EXPECT_LE(param[JointBrittle::kTension] * param[JointBrittle::kTanPhi],
              param[JointBrittle::kCohesion] * (1 + 1e-12));
    if (i > 0 && t.face[i] == t.face[i - 1]) {
      EXPECT_EQ(t.joint[i], t.joint[i - 1]);
      EXPECT_NEAR(t.kn[i] / t.area[i], t.kn[i - 1] / t.area[i - 1], 1e-6 * t.kn[i] / t.area[i]);
    } else {
      cohesions.push_back(param[JointBrittle::kCohesion]);
    }
  }
  ASSERT_EQ(cohesions.size(), 54u);
  std::sort(cohesions.begin(), cohesions.end());
  EXPECT_GT(PValue(cohesions, [](double x) { return (x - 1e5) / 2e5; }), 0.01);
}

TEST(ScatterRanks, DoNotMatter) {
  ExpectRanksDoNotMatter(
      BreakingScene("hex") +
      " -ts_max_steps 600 -interface_j_cohesion_scatter weibull:3 -interface_j_ks_scatter uniform:0.4");
  ExpectRanksDoNotMatter(std::string(kBrick) +
                         " -block_young_scatter weibull:4 -ts_max_steps 60 -interfaces j -interface_j_on all");
}

}  // namespace
}  // namespace cdem
