// One Gauss point of a block law under strains given in its principal frame, for tests of laws.
#pragma once
#include "forces/bodies.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cdem {

using Vec3 = std::array<double, 3>;
using Sym = std::array<double, 6>;

inline constexpr double kYoung = 7e9, kPoisson = 0.2;
inline const double kG = kYoung / (2 * (1 + kPoisson)), kK = kYoung / (3 * (1 - 2 * kPoisson));

/// Rows: an orthonormal frame. Seed 0: that of the axes.
struct Frame {
  double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  explicit Frame(unsigned seed = 0) {
    if (seed == 0) return;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> entry;
    for (auto &row : r)
      for (double &value : row) value = entry(random);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < i; ++j) {
        const double along = Dot(r[i], r[j]);
        for (int k = 0; k < 3; ++k) r[i][k] -= along * r[j][k];
      }
      const double size = std::sqrt(Dot(r[i], r[i]));
      for (double &value : r[i]) value /= size;
    }
    Cross(r[0], r[1], r[2]);
  }
  /// The tensor with these principal values.
  Sym Tensor(const Vec3 &v) const {
    const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    Sym t{};
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < 3; ++i) t[k] += v[i] * r[i][row[k]] * r[i][column[k]];
    return t;
  }
};

inline Vec3 operator+(Vec3 a, const Vec3 &b) {
  for (int i = 0; i < 3; ++i) a[i] += b[i];
  return a;
}
inline Vec3 operator-(Vec3 a, const Vec3 &b) {
  for (int i = 0; i < 3; ++i) a[i] -= b[i];
  return a;
}
inline Vec3 operator*(double s, Vec3 a) {
  for (double &value : a) value *= s;
  return a;
}
inline double Trace(const Vec3 &a) { return a[0] + a[1] + a[2]; }
inline Vec3 Strain(const Vec3 &s) {
  const double side = kPoisson / kYoung * Trace(s);
  return {(1 + kPoisson) / kYoung * s[0] - side, (1 + kPoisson) / kYoung * s[1] - side,
          (1 + kPoisson) / kYoung * s[2] - side};
}
inline Vec3 ElasticStress(const Vec3 &e) {
  const double side = (kK - 2 * kG / 3) * Trace(e);
  return {2 * kG * e[0] + side, 2 * kG * e[1] + side, 2 * kG * e[2] + side};
}
inline double Size(const Vec3 &a) { return std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])}); }

/// A point of this law with its state. properties: those after young and poisson.
template <class Law>
struct PointAt {
  double param[kMaxParams] = {};
  Sym stress{};
  double state[Law::kState] = {};

  explicit PointAt(std::vector<double> properties, double size = 1) {
    properties.insert(properties.begin(), {kYoung, kPoisson});
    for (std::size_t i = properties.size(); i < Law::kProperties.size(); ++i)
      properties.push_back(Law::kProperties[i].fallback);
    EXPECT_EQ(Law::Check(properties.data()), "");
    Law::Derive(properties.data(), size, param);
  }
  bool Move(const Sym &strain) { return Law::Stress(param, strain.data(), state, stress.data()); }
  bool Move(const Vec3 &principal, const Frame &frame = Frame()) { return Move(frame.Tensor(principal)); }

  void ExpectStress(const Vec3 &principal, const Frame &frame, double scale = 0) const {
    const Sym exact = frame.Tensor(principal);
    const double bar = 1e-12 * std::max(Size(principal), scale);
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(stress[k], exact[k], bar) << "component " << k;
  }
};

/// Koiter's rule read backwards: the elastic strain of a stress on the surface, plus any positive multiples of its flow
/// directions, must give that stress and these plastic strains. Both in principal values, in several frames and steps.
template <class Law>
void ExpectReturnsTo(const std::vector<double> &properties, const Vec3 &stress, const std::vector<Vec3> &flows,
                     double scale = 0) {
  scale = std::max(scale, Size(stress));
  for (unsigned seed : {0u, 1u, 2u}) {
    const Frame frame(seed);
    PointAt<Law> p(properties);
    Vec3 plastic{};
    p.Move(0.5 * Strain(stress), frame);
    for (double value : p.state) EXPECT_NEAR(value, 0, 1e-18);  // half the stress may lie on the surface
    for (int step = 1; step <= 4; ++step) {
      for (std::size_t i = 0; i < flows.size(); ++i)
        plastic = plastic + (1e-4 * step / (1.0 + static_cast<double>(i))) * flows[i];
      const Vec3 strain = Strain(stress) + plastic;
      EXPECT_TRUE(p.Move(strain, frame));
      const double trial = Size(ElasticStress(strain));
      p.ExpectStress(stress, frame, std::max(scale, trial));
      const Sym exact = frame.Tensor(plastic);
      for (int k = 0; k < 6; ++k) EXPECT_NEAR(p.state[k], exact[k], 1e-12 * std::max(Size(strain), trial / kG));
      if (testing::Test::HasFailure()) {
        std::printf("stress %g %g %g, frame %u, step %d\n", stress[0], stress[1], stress[2], seed, step);
        return;
      }
    }
    // unloading and loading again are elastic, to the same point
    const double before = p.state[6];
    const Vec3 strain = Strain(stress) + plastic;
    p.Move(strain - 0.25 * Strain(stress), frame);
    EXPECT_NEAR(p.state[6], before, 1e-12 * (before + 1e-3));
    p.ExpectStress(0.75 * stress, frame, scale);
    p.Move(strain, frame);
    p.ExpectStress(stress, frame, scale);
    EXPECT_NEAR(p.state[6], before, 1e-12 * (before + 1e-3));
  }
}

/// The same point in lanes and alone, to the last bit: random strains, some of them simple, with states left by earlier
/// ones. [in] least: lanes that must have changed, and must not.
template <class Law>
void ExpectLanesEqualDouble(const std::vector<std::vector<double>> &properties, int least) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  int seen[2] = {0, 0};
  for (int round = 0; round < 600; ++round) {
    Lanes param[kMaxParams] = {}, state[Law::kState] = {}, strain[6], stress[6];
    std::vector<PointAt<Law>> alone;
    for (int l = 0; l < kLanes; ++l) {
      alone.emplace_back(properties[(round + l) % properties.size()]);
      for (int p = 0; p < kMaxParams; ++p) param[p][l] = alone[l].param[p];
    }
    for (int step = 0; step < 4; ++step) {
      std::vector<Sym> e(kLanes);
      for (int l = 0; l < kLanes; ++l) {
        const double size = 3e-3 * std::fabs(entry(random));
        for (int k = 0; k < 6; ++k) e[l][k] = (round + l) % 5 == 0 && k >= 3 ? 0 : size * entry(random);
        if ((round + l) % 7 == 0) e[l][1] = e[l][0];
        if ((round + l) % 11 == 0) e[l] = {e[l][0], e[l][0], e[l][0], 0, 0, 0};
        if ((round + l) % 13 == 0) e[l] = {};
        for (int k = 0; k < 6; ++k) strain[k][l] = e[l][k];
      }
      const MaskOf<Lanes> changed = Law::Stress(param, strain, state, stress);
      for (int l = 0; l < kLanes; ++l) {
        PointAt<Law> &p = alone[l];
        const bool yielded = p.Move(e[l]);
        ++seen[yielded];
        EXPECT_EQ(yielded, changed[l] != 0);
        for (int k = 0; k < 6; ++k) {
          const double lane = stress[k][l];
          EXPECT_EQ(std::memcmp(&lane, &p.stress[k], sizeof lane), 0) << lane - p.stress[k];
        }
        for (int k = 0; k < Law::kState; ++k) {
          const double lane = state[k][l];
          EXPECT_EQ(std::memcmp(&lane, &p.state[k], sizeof lane), 0) << lane - p.state[k];
        }
      }
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(seen[0], least);
  EXPECT_GT(seen[1], least);
}

}  // namespace cdem
