// Element forms by themselves: zero modes, energies, what each form promises, and lanes = double to the last bit.
#include "forces/bodies.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace cdem {
namespace {

constexpr double kCube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
constexpr int kOfShape[kShapes][8] = {{0, 1, 3, 4}, {0, 1, 3, 4, 5, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};

/// Calls f(Form{}) with every element form there is.
template <class F>
void EachForm(F &&f) {
  for (Shape shape : {Shape::kTet, Shape::kWedge, Shape::kHex})
    VisitForms(shape, [&](auto forms) {
      for (int form = 0; form < decltype(forms)::kCount; ++form) VisitElement(shape, form, f);
    });
}

/// Corners of an element: those of a cube of edge h, moved at random by up to jitter h, each by itself, or by a linear map
/// for forms that want it.
template <class Form>
std::vector<double> Corners(double h, double jitter, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  double map[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) map[i][k] = Form::kAffine ? (i == k) + shift(random) : i == k;
  std::vector<double> x;
  for (int a = 0; a < Form::kCorners; ++a) {
    const double *cube = kCube[kOfShape[static_cast<int>(Form::kShape)][a]];
    for (const double *row : map) x.push_back(h * (Dot(row, cube) + (Form::kAffine ? 0 : shift(random))));
  }
  return x;
}

/// Elastic forces and energy of one element.
template <class Form>
std::vector<double> ElasticForces(const std::vector<double> &x, const std::vector<double> &u, double poisson,
                                  double *energy = nullptr) {
  const double property[] = {1e10, poisson};
  double param[kMaxParams], corner[Form::kCorners][3], w[Form::kCorners][3], f[Form::kCorners][3];
  Elastic::Derive(property, 1, param);
  std::memcpy(corner, x.data(), sizeof corner);
  std::memcpy(w, u.data(), sizeof w);
  ElementSums<double> sums;
  ElementForce<Form, Elastic, true, double>(corner, w, param, f, &sums);
  if (energy) *energy = sums.energy;
  return {&f[0][0], &f[0][0] + 3 * Form::kCorners};
}

/// Eigenvalues of a symmetric matrix [n][n], ascending, by Jacobi's rotations.
std::vector<double> Eigenvalues(std::vector<double> a, int n) {
  auto at = [&](int i, int j) -> double & { return a[static_cast<std::size_t>(n) * i + j]; };
  for (int sweep = 0; sweep < 12; ++sweep)
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        if (at(p, q) == 0) continue;
        const double theta = 0.5 * (at(q, q) - at(p, p)) / at(p, q);
        const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < n; ++k) {
          const double kp = at(k, p), kq = at(k, q);
          at(k, p) = c * kp - s * kq, at(k, q) = s * kp + c * kq;
        }
        for (int k = 0; k < n; ++k) {
          const double pk = at(p, k), qk = at(q, k);
          at(p, k) = c * pk - s * qk, at(q, k) = s * pk + c * qk;
        }
      }
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(at(i, i));
  std::sort(values.begin(), values.end());
  return values;
}

TEST(Forms, HaveASymmetricStiffnessWithSixZeroModes) {
  for (double poisson : {0.0, 0.25, 0.45})
    for (unsigned seed : {1u, 2u, 3u})
      EachForm([&](auto form) {
        using Form = decltype(form);
        constexpr int n = 3 * Form::kCorners;
        SCOPED_TRACE(std::string(Info(Form::kShape).name) + " " + Form::kName);
        const std::vector<double> x = Corners<Form>(1, 0.2, seed);
        std::vector<double> k, u(n, 0.0);
        for (int j = 0; j < n; ++j) {
          u[j] = 1;
          const std::vector<double> f = ElasticForces<Form>(x, u, poisson);
          k.insert(k.end(), f.begin(), f.end());
          u[j] = 0;
        }
        const double size = *std::max_element(k.begin(), k.end());
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < i; ++j) EXPECT_NEAR(k[n * i + j], k[n * j + i], 1e-12 * size);
        const std::vector<double> value = Eigenvalues(k, n);
        if (seed == 1 && poisson == 0.25)
          std::printf("    %-6s %-8s eigenvalues over the largest: 6th %8.1e, 7th %8.1e\n", Info(Form::kShape).name,
                      Form::kName, std::fabs(value[5]) / value[n - 1], value[6] / value[n - 1]);
        for (int i = 0; i < 6; ++i) EXPECT_LT(std::fabs(value[i]), 1e-12 * value[n - 1]);
        EXPECT_GT(value[6], 1e-3 * value[n - 1]);
      });
}

TEST(Forms, EnergyIsTheWorkOfTheForces) {
  EachForm([&](auto form) {
    using Form = decltype(form);
    const std::vector<double> x = Corners<Form>(2, 0.2, 7);
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
    std::vector<double> u(x.size());
    for (double &value : u) value = entry(random);
    double energy, work = 0;
    const std::vector<double> f = ElasticForces<Form>(x, u, 0.3, &energy);
    for (std::size_t i = 0; i < u.size(); ++i) work += 0.5 * u[i] * f[i];
    EXPECT_GT(work, 0);
    EXPECT_NEAR(energy, work, 1e-12 * work) << Info(Form::kShape).name << " " << Form::kName;
  });
}

/// Energy of a cube of edge h in bending, u_x = a xi eta.
template <class Form>
double BendingEnergy(double h, double a, double poisson) {
  const std::vector<double> x = Corners<Form>(h, 0, 1);
  std::vector<double> u(x.size(), 0.0);
  double energy;
  for (int c = 0; c < 8; ++c) u[3 * c] = a * (2 * kCube[c][0] - 1) * (2 * kCube[c][1] - 1);
  ElasticForces<Form>(x, u, poisson, &energy);
  return energy;
}

TEST(Forms, BendingOfACube) {
  const double h = 3, a = 1e-3, beam = 2.0 / 3 * 1e10 * h * a * a;  // E (2 a/h^2)^2 h^3/12 h/2
  EXPECT_NEAR(BendingEnergy<HexOnePoint>(h, a, 0), beam, 1e-13 * beam);
  EXPECT_NEAR(BendingEnergy<HexFull>(h, a, 0), 1.5 * beam, 1e-13 * beam);
  EXPECT_NEAR(BendingEnergy<HexBbar>(h, a, 0), 7.0 / 6 * beam, 1e-13 * beam);
  EXPECT_NEAR(BendingEnergy<HexSpring>(h, a, 0), 4.5 * beam, 1e-13 * beam);
}

/// Forces of one hexahedron, which nobody looks at.
template <class Form>
std::vector<double> PlainForces(const std::vector<double> &x, const std::vector<double> &u, double poisson) {
  const double property[] = {1e10, poisson};
  double param[kMaxParams], corner[8][3], w[8][3], f[8][3];
  Elastic::Derive(property, 1, param);
  std::memcpy(corner, x.data(), sizeof corner);
  std::memcpy(w, u.data(), sizeof w);
  ElementForce<Form, Elastic, false, double>(corner, w, param, f, nullptr);
  return {&f[0][0], &f[0][0] + 24};
}

TEST(Forms, OfParallelepipedsAreThoseOfFullIntegration) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
  double most = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const std::vector<double> x = Corners<HexAffine>(seed % 2 ? 1e-3 : 20, seed % 4 < 2 ? 0.1 : 0.45, seed);
    std::vector<double> u(24);
    for (double &value : u) value = entry(random);
    const double poisson = 0.06 * (seed % 9);
    const std::vector<double> full = PlainForces<HexFull>(x, u, poisson),
                              affine = PlainForces<HexAffine>(x, u, poisson);
    double size = 0, difference = 0;
    for (int i = 0; i < 24; ++i) {
      size = std::max(size, std::fabs(full[i]));
      difference = std::max(difference, std::fabs(full[i] - affine[i]));
    }
    most = std::max(most, difference / size);
    EXPECT_NE(full, affine) << "one was not computed by its own formula";
  }
  std::printf("    largest difference: %.1e of the largest force\n", most);
  EXPECT_LT(most, 1e-13);
}

TEST(Forms, KnowTheirParallelepipeds) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<double> exact = Corners<HexAffine>(2, 0.3, seed);
    double x[8][3];
    for (double far : {0.0, 100.0, -1000.0}) {  // rounding of coordinates is no shape
      for (int i = 0; i < 24; ++i) x[i / 3][i % 3] = exact[i] + far;
      EXPECT_TRUE(HexAffine::Serves(x)) << far;
    }
    for (int i = 0; i < 24; ++i) x[i / 3][i % 3] = exact[i];
    const int corner = seed % 8, k = seed % 3;
    x[corner][k] += 1e-11;
    EXPECT_FALSE(HexAffine::Serves(x));
    x[corner][k] = std::nan("");
    EXPECT_FALSE(HexAffine::Serves(x));
  }
}

/// All points see one dilatation, and it is the pressure's partner in work: the mean of div u.
template <class Form>
void ExpectOneDilatation() {
  const std::vector<double> x = Corners<Form>(1, 0.2, 4);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
  double corner[Form::kCorners][3], u[Form::kCorners][3], f[Form::kCorners][3], volume = 0, work = 0;
  std::memcpy(corner, x.data(), sizeof corner);
  for (auto &row : u)
    for (double &value : row) value = entry(random);
  std::vector<double> seen;
  const auto pressed = [&](int, const double *strain, double share, double *stress) {
    seen.push_back(strain[kXX] + strain[kYY] + strain[kZZ]);
    volume += share;
    for (int i = 0; i < 6; ++i) stress[i] = i < 3 ? 1 : 0;
  };
  Form::Forces(corner, u, pressed, f);
  ASSERT_EQ(static_cast<int>(seen.size()), Form::kPoints);
  EXPECT_GT(std::fabs(seen[0]), 1e-5);
  for (double dilatation : seen) EXPECT_NEAR(dilatation, seen[0], 1e-15);
  for (int c = 0; c < Form::kCorners; ++c) work += Dot(f[c], u[c]);
  EXPECT_NEAR(work, volume * seen[0], 1e-15);
}

TEST(Forms, BbarSeesTheMeanDilatationAlone) {
  ExpectOneDilatation<HexBbar>();
  ExpectOneDilatation<WedgeBbar>();
}

/// One element of every lane by lanes and by double, through all laws and with beta; both must agree to the last bit.
template <class Form, class Law, bool kBeta>
void ExpectLanesEqualDouble() {
  constexpr int corners = Form::kCorners, states = Form::kPoints * Law::kState, room = states > 0 ? states : 1;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> entry(-1, 1);
  std::vector<double> property(kMaxProperties);
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i) {  // a material that yields at this size of strain
    const Property &p = Law::kProperties[i];
    property[i] = !std::isnan(p.fallback)            ? p.fallback
                  : std::string(p.unit) == "Pa"      ? 1e6
                  : std::string(p.unit) == "degrees" ? 30
                                                     : 0.25;
  }
  property[0] = 1e9;
  double param[kMaxParams] = {};
  Law::Derive(property.data(), 1, param);
  for (int round = 0; round < 60; ++round) {
    Lanes x[corners][3], u[corners][3], rate[corners][3], f[corners][3], lane_param[kMaxParams];
    const double size = round % 3 == 0 ? 1e-5 : round % 3 == 1 ? 1e-3 : 1e-2;
    for (int p = 0; p < kMaxParams; ++p) lane_param[p] = Lanes{} + param[p];
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < kLanes; ++l) {
          x[a][k][l] = kCube[kOfShape[static_cast<int>(Form::kShape)][a]][k] + 0.2 * entry(random);
          u[a][k][l] = size * entry(random), rate[a][k][l] = size * entry(random);
        }
    double value[room][kLanes] = {}, alone[kLanes][room] = {};
    ElementHistory<Lanes> history{&value[0][0], kLanes, LaneMask{}, LaneMask{}, LaneMask{}, LaneMask{}};
    ElementSums<Lanes> sums;
    ElementStep<Form, Law, kBeta, false>(x, u, rate, lane_param, &history, f, &sums);
    for (int l = 0; l < kLanes; ++l) {
      double x1[corners][3], u1[corners][3], rate1[corners][3], f1[corners][3];
      for (int a = 0; a < corners; ++a)
        for (int k = 0; k < 3; ++k) x1[a][k] = x[a][k][l], rate1[a][k] = rate[a][k][l], u1[a][k] = u[a][k][l];
      ElementHistory<double> one{alone[l], 1, false, false, false, false};
      ElementSums<double> sums1;
      if (kBeta && Law::kLinear)  // the lanes above were changed in place
        for (int a = 0; a < corners; ++a)
          for (int k = 0; k < 3; ++k) rate1[a][k] = 0;
      ElementStep<Form, Law, kBeta, false, double>(x1, u1, rate1, param, &one, f1, &sums1);
      for (int a = 0; a < corners; ++a)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(f1[a][k], f[a][k][l]);
      for (int s = 0; s < states; ++s) EXPECT_EQ(alone[l][s], value[s][l]);
      if (testing::Test::HasFailure()) return;
    }
  }
}

// Laws by themselves are in lanes_test.cxx: here one without history, one with, and those of corners.
TEST(Forms, LanesEqualDoubleToTheLastBit) {
  EachForm([&](auto form) {
    using Form = decltype(form);
    SCOPED_TRACE(std::string(Info(Form::kShape).name) + " " + Form::kName);
    if constexpr (Form::kAtCorners) {
      ExpectLanesEqualDouble<Form, SpringBlock, false>();
      ExpectLanesEqualDouble<Form, SpringBlock, true>();
    } else {
      ExpectLanesEqualDouble<Form, Elastic, true>();
      if constexpr (kFits<Form, DruckerPrager>) ExpectLanesEqualDouble<Form, DruckerPrager, false>();
    }
  });
}

}  // namespace
}  // namespace cdem
