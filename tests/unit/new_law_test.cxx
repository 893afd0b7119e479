// A new law is one struct and one name in a list: here a block law and two interface laws, made as physics/law.hpp asks,
// through the same bodies as the program's own.
#include "forces/bodies.hpp"

#include <gtest/gtest.h>
#include <random>

namespace cdem {
namespace {

/// Elastic, with twice the lambda.
struct Stiffer : BlockLawDefaults {
  static constexpr const char *kName = "stiffer";
  static constexpr bool kLinear = true;
  enum { kLambda, kMu, kParams };
  static constexpr auto kProperties = Elastic::kProperties;

  static void Derive(const double *property, double size, double *param) {
    Elastic::Derive(property, size, param);
    param[kLambda] *= 2;
  }
  template <class T>
  static CDEM_HD void Stress(const T *param, const T strain[6], T stress[6]) {
    Elastic::Stress(param, strain, stress);
  }
};

/// A linear interface law: no shear at all.
struct Slippery : JointLawDefaults {
  static constexpr const char *kName = "slippery";
  static constexpr bool kLinear = true;
  static constexpr bool kHistory = false;
  enum { kParams };
  static constexpr std::array<Property, 0> kProperties = {};
  static void Derive(const double *, double *) {}

  template <class T>
  static CDEM_HD void Force(const T normal[3], T kn, T, const T d[3], T force[3]) {
    T along = kn * Dot(normal, d);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = -(along * normal[k]);
  }
};

/// An interface law with history: it opens at its strength in tension, never slides, and counts its evaluations since.
struct Glue : JointLawDefaults {
  static constexpr const char *kName = "glue";
  enum { kTension, kParams };
  enum { kCount, kNumbers };
  static constexpr int kState = kNumbers;
  static constexpr std::array<Property, 1> kProperties = {{{"strength", "Pa", 0, kPropertyInf, kPropertyOpen}}};
  static void Derive(const double *property, double *param) { param[kTension] = property[0]; }

  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    JointElastic::Force(s.normal, s.kn, s.ks, s.d, force);
    const T strength = s.param[kTension] * s.area * (1.0 - s.tension_lost);
    Outcome<T> out;
    out.open = (-Dot(s.normal, force) >= strength) & (Dot(s.normal, s.d) > T{});
    out.slides = T{} < T{};
    out.tension_lost = out.cohesion_lost = out.changed = out.open;
    CDEM_UNROLL for (int k = 0; k < 3; ++k) force[k] = out.open ? T{} : force[k];
    s.history[kCount] = out.open ? s.history[kCount] + 1.0 : s.history[kCount];
    return out;
  }
};

/// Glue that dries: another law of the same name, for great strengths.
struct StrongGlue : Glue {
  static bool Serves(const double *property) { return property[0] > 100; }
};

using Blocks = LawList<Elastic, Stiffer>;
using Joints = LawList<JointElastic, JointBrittle, Slippery, StrongGlue, Glue>;

TEST(NewLaw, IsFoundByItsName) {
  EXPECT_EQ(Blocks::kCount, 2);
  EXPECT_EQ(Blocks::Names(), "elastic, stiffer");
  EXPECT_EQ(Blocks::Find("stiffer"), 1);
  EXPECT_EQ(Blocks::Find("elastic"), 0);
  EXPECT_EQ(Blocks::Find("stiff"), -1);
  EXPECT_EQ(Joints::Names(), "elastic, brittle, slippery, glue");
  EXPECT_EQ(Joints::Find("glue"), 3);
  for (int law = 0; law < Joints::kCount; ++law) {
    int calls = 0;
    Joints::Visit(law, [&](auto l) {
      ++calls;
      EXPECT_EQ(Joints::Find(decltype(l)::kName), std::min(law, 3));
    });
    EXPECT_EQ(calls, 1);
  }
}

TEST(NewLaw, OfOneNameIsChosenByItsProperties) {
  const double weak[kMaxProperties] = {10}, strong[kMaxProperties] = {200};
  EXPECT_EQ(Joints::Choose(3, weak), 4);
  EXPECT_EQ(Joints::Choose(4, weak), 4);
  EXPECT_EQ(Joints::Choose(4, strong), 3);
  EXPECT_EQ(Joints::Choose(0, nullptr), 0);
  const double plain[5] = {1, 1, 30, 0, 1}, dilates[5] = {1, 1, 30, 5, 1};
  for (const char *name : {"brittle", "softening"}) {
    const int first = JointLaws::Find(name);
    EXPECT_EQ(JointLaws::Choose(first, plain), first);
    EXPECT_EQ(JointLaws::Choose(first, dilates), first + 1);
  }
  EXPECT_EQ(JointLaws::Names(), "elastic, brittle, softening");
}

TEST(NewLaw, PropertiesHaveTheirBounds) {
  EXPECT_FALSE(Stiffer::kProperties[0].Allows(0));
  EXPECT_TRUE(Stiffer::kProperties[0].Allows(1e9));
  EXPECT_FALSE(Stiffer::kProperties[1].Allows(0.5));
  EXPECT_TRUE(JointBrittle::kProperties[0].Allows(0));
  EXPECT_FALSE(JointBrittle::kProperties[2].Allows(90));
}

/// Corner forces of an element of this shape by the law of that number, whose parameters its own Derive makes.
template <class Form>
std::vector<double> CornerForces(int law, double lambda_factor) {
  const double corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const int of_shape[kShapes][8] = {{0, 1, 3, 4}, {0, 1, 3, 4, 5, 7}, {0, 1, 2, 3, 4, 5, 6, 7}};
  const double property[] = {3e9, 0.3};
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> entry(-0.1, 0.1);
  Lanes x[Form::kCorners][3], u[Form::kCorners][3], f[Form::kCorners][3], param[kMaxParams] = {};
  for (int l = 0; l < kLanes; ++l)
    for (int a = 0; a < Form::kCorners; ++a)
      for (int k = 0; k < 3; ++k) {
        x[a][k][l] = corner[of_shape[static_cast<int>(Form::kShape)][a]][k] + entry(random);
        u[a][k][l] = 1e-3 * entry(random);
      }
  std::vector<double> forces;
  Blocks::Visit(law, [&](auto l) {
    using Law = decltype(l);
    double derived[kMaxParams] = {};
    Law::Derive(property, 1, derived);
    derived[Elastic::kLambda] *= lambda_factor;
    for (int p = 0; p < Law::kParams; ++p) param[p] = Lanes{} + derived[p];
    ElementSums<Lanes> sums;
    ElementForce<Form, Law, true>(x, u, param, f, &sums);
    for (int lane = 0; lane < kLanes; ++lane) EXPECT_GT(sums.energy[lane], 0);
  });
  for (const auto &of_corner : f)
    for (const Lanes &component : of_corner)
      for (int l = 0; l < kLanes; ++l) forces.push_back(component[l]);
  return forces;
}

TEST(NewLaw, OfBlocksRunsInEveryElement) {
  for (Shape shape : {Shape::kTet, Shape::kWedge, Shape::kHex})
    VisitForms(shape, [&](auto forms) {
      for (int number = 0; number < decltype(forms)::kCount; ++number)
        VisitElement(shape, number, [&](auto form) {
          using Form = decltype(form);
          const int law = Blocks::Find("stiffer");
          EXPECT_EQ(CornerForces<Form>(law, 1), CornerForces<Form>(Blocks::Find("elastic"), 2));
          EXPECT_NE(CornerForces<Form>(law, 1), CornerForces<Form>(Blocks::Find("elastic"), 1));
        });
    });
}

/// The force of a spring of normal z by the law of that name; its state and count after a committing evaluation.
std::array<double, 3> SpringOf(const char *law, double x, double z, std::uint8_t *state, double *count) {
  std::array<double, 3> force{};
  const double property[5] = {10, 10, 30, 0, 1};
  Joints::Visit(Joints::Choose(Joints::Find(law), property), [&](auto l) {
    using Law = decltype(l);
    double param[kMaxParams] = {};
    Law::Derive(property, param);
    Spring<double> s = {{0, 0, 1}, 100,     50, 0.5, {x, 0, z}, {0, 0, 0}, param, *state & kTensionLost ? 1.0 : 0,
                        0,         {*count}};
    const auto out = SpringForce<Law, false>(s, force.data());
    if (Law::kHistory) *state = NextState(*state, StateBits(out));
    if (out.changed) *count = s.history[0];
  });
  return force;
}

TEST(NewLaw, OfInterfacesRunsInSprings) {
  using Force = std::array<double, 3>;
  std::uint8_t state = 0;
  double count = 0;
  EXPECT_EQ(SpringOf("elastic", 0.5, -0.25, &state, &count), (Force{-25, 0, 25}));
  EXPECT_EQ(SpringOf("slippery", 0.5, -0.25, &state, &count), (Force{0, 0, 25}));
  EXPECT_EQ(state, 0);
  EXPECT_EQ(SpringOf("glue", 0.5, 0.03125, &state, &count), (Force{-25, 0, -3.125})) << "below its strength of 5 N";
  EXPECT_EQ(state, 0);
  EXPECT_EQ(SpringOf("glue", 0.5, 0.0625, &state, &count), (Force{0, 0, 0}));
  EXPECT_EQ(state, kTensionLost | kCohesionLost | kOpen);
  EXPECT_EQ(SpringOf("glue", 0.5, 0.03125, &state, &count), (Force{0, 0, 0})) << "it has none left";
  EXPECT_EQ(SpringOf("glue", 0.5, -0.25, &state, &count), (Force{-25, 0, 25}));
  EXPECT_EQ(count, 2) << "evaluations in which it was open";
}

}  // namespace
}  // namespace cdem
