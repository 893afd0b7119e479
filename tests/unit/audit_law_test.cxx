// That the balance proves something: one spring, one element, moved by hand; the work of the forces that the scheme would
// feel, against stored energy and dissipation. A law whose return is wrong does not close.
#include "forces/element_audit.hpp"
#include "forces/spring_audit.hpp"

#include <gtest/gtest.h>
#include <random>

namespace cdem {
namespace {

/// Moves a spring along a random path of opening, closing and sliding. [out] dissipated: by kind.
template <class Law>
double SpringMissing(double *dissipated, double *work) {
  double param[kMaxParams] = {};
  const double property[] = {2e5, 4e5, 30, Law::kCarriesOffset ? 8.0 : 0.0, 1e-3, 5, 20};
  Law::Derive(property, param);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  double history[kMaxSpringState] = {}, d[3] = {0, 0, 0}, before[3] = {0, 0, 0}, stored = 0, peak = 0;
  std::uint8_t state = 0;
  *work = *dissipated = 0;
  double target[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    if (i % 200 == 0)
      for (int k = 0; k < 3; ++k) target[k] = (k == 2 ? 2e-5 : 1e-4) * unit(random) - (k == 2 ? 1e-5 : 0);
    double step[3];
    for (int k = 0; k < 3; ++k) step[k] = (target[k] - d[k]) * 0.02, d[k] += step[k];
    Spring<double> s{};
    s.normal[2] = 1;
    std::copy_n(d, 3, s.d);
    s.kn = 2e11, s.ks = 1e11, s.area = 1;
    s.param = param;
    s.tension_lost = state & kTensionLost ? 1 : 0;
    s.cohesion_lost = state & kCohesionLost ? 1 : 0;
    std::copy_n(history, kMaxSpringState, s.history);
    SpringBefore<double> was;
    std::copy_n(history, kMaxSpringState, was.history);
    was.open = state & kOpen, was.tension_lost = state & kTensionLost, was.any = state != 0;
    double force[3];
    const Outcome<double> out = SpringForce<Law, false>(s, force);
    double loss[kSpringWorks] = {};
    if (MayDissipate<Law>(was, out)) SpringDissipation<Law>(s, was, out, force, step, loss);
    *dissipated += loss[kFriction] + loss[kSpringFracture] + loss[kContact];
    for (int k = 0; k < 3; ++k) *work -= 0.5 * (before[k] + force[k]) * step[k];
    std::copy_n(force, 3, before);
    state = NextState(state, StateBits(out));
    if (out.changed) std::copy_n(s.history, kMaxSpringState, history);
    stored = Law::Energy(s, force);
    peak = std::max(peak, std::fabs(*work));
  }
  return std::fabs(*work - stored - *dissipated) / peak;
}

/// A return that stores half of the slip that it makes.
struct Forgetful : JointBrittle {
  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    T before[3] = {s.history[0], s.history[1], s.history[2]};
    const Outcome<T> out = JointBrittle::Force<kBeta>(s, force);
    for (int k = 0; k < 3; ++k) s.history[k] = 0.5 * (before[k] + s.history[k]);
    return out;
  }
};
/// A return that gives a twentieth more force than its state stores.
struct Generous : JointBrittle {
  template <bool kBeta, class T>
  static CDEM_HD Outcome<T> Force(Spring<T> &s, T force[3]) {
    const Outcome<T> out = JointBrittle::Force<kBeta>(s, force);
    for (int k = 0; k < 2; ++k) force[k] = out.slides ? 1.05 * force[k] : force[k];
    return out;
  }
};

TEST(AuditLaw, SpringsCloseAndWrongOnesDoNot) {
  double dissipated, work;
  EXPECT_LT(SpringMissing<JointBrittle>(&dissipated, &work), 1e-12);
  EXPECT_GT(dissipated, 0.5 * work);
  EXPECT_LT(SpringMissing<JointBrittleDilating>(&dissipated, &work), 1e-12);
  EXPECT_LT(SpringMissing<JointSoftening>(&dissipated, &work), 1e-12);
  EXPECT_GT(dissipated, 0.5 * work);
  EXPECT_LT(SpringMissing<JointSofteningDilating>(&dissipated, &work), 1e-12);
  const double forgetful = SpringMissing<Forgetful>(&dissipated, &work);
  const double generous = SpringMissing<Generous>(&dissipated, &work);
  std::printf(
      "    missing of the work: %.3g where half of the slip is stored, %.3g where the force is 5 %% too large\n",
      forgetful, generous);
  EXPECT_GT(forgetful, 1e-2);
  EXPECT_GT(generous, 1e-3);
}

/// Strains a distorted element along a random path; the share of the work that is missing.
template <class Form, class Law>
double ElementMissing(const double *property, double *dissipated, double *work) {
  constexpr int corners = Form::kCorners;
  static const double cube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  static const double tet[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  double param[kMaxParams] = {}, x[corners][3], u[corners][3] = {}, target[corners][3] = {}, f_before[corners][3] = {};
  Law::Derive(property, 1, param);
  for (int a = 0; a < corners; ++a)
    for (int k = 0; k < 3; ++k) x[a][k] = (corners == 8 ? cube[a][k] : tet[a][k]) + 0.1 * unit(random);
  std::vector<double> value(static_cast<std::size_t>(Form::kPoints) * std::max(1, Law::kState), 0.0);
  ElementHistory<double> history;
  history.value = value.data();
  history.stride = 1;
  history.touched = history.tension = history.shear = false;
  double stored = 0, peak = 0;
  *work = *dissipated = 0;
  for (int i = 0; i < 4000; ++i) {
    if (i % 100 == 0)
      for (auto &corner : target)
        for (double &t : corner) t = 1e-4 * unit(random);
    double step[corners][3], f[corners][3], seen[corners][3];
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k) step[a][k] = 0.03 * (target[a][k] - u[a][k]), u[a][k] += step[a][k];
    history.changed = false;
    ElementHistory<double> observed = history;
    ElementSums<double> sums;
    ElementAudit<double> audit;
    audit.step = step;
    audit.dt = 1;
    ElementStep<Form, Law, false, true>(x, u, static_cast<const double(*)[3]>(nullptr), param, &observed, seen, &sums);
    AuditedStep<Form, Law>(x, u, static_cast<const double(*)[3]>(nullptr), param, &history, f, &audit);
    history.touched = history.touched || history.changed;
    stored = sums.energy;
    *dissipated += audit.work[kPlastic] + audit.work[kElementFracture];
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(f[a][k], seen[a][k], 1e-6);
        *work += 0.5 * (f[a][k] + f_before[a][k]) * step[a][k];
        f_before[a][k] = f[a][k];
      }
    peak = std::max(peak, std::fabs(*work));
  }
  return std::fabs(*work - stored - *dissipated) / peak;
}

/// A return that stores nine tenths of the plastic strain that it makes.
struct Leaky : MohrCoulomb {
  template <class T>
  static CDEM_HD MaskOf<T> Stress(const T *param, const T strain[6], T state[kState], T stress[6]) {
    T before[kState];
    for (int i = 0; i < kState; ++i) before[i] = state[i];
    const MaskOf<T> changed = MohrCoulomb::Stress(param, strain, state, stress);
    for (int i = 0; i < 6; ++i) state[i] = before[i] + 0.9 * (state[i] - before[i]);
    return changed;
  }
};

TEST(AuditLaw, ElementsCloseAndWrongOnesDoNot) {
  const double mohr[] = {1e10, 0.25, 1e5, 30, 10, 5e4}, inf = kPropertyInf;
  const double drucker[] = {1e10, 0.25, 1e5, 30, 5, 5e4, 1, 500, 2e4, inf, inf};
  const double breakage[] = {1e10, 0.25, 1e5, 30, 5e4, 1e4, 20}, spring[] = {1e10, 0.25, 5e4, 1e5, 30, 20};
  double dissipated, work;
  EXPECT_LT((ElementMissing<HexFull, MohrCoulomb>(mohr, &dissipated, &work)), 1e-12);
  EXPECT_GT(dissipated, 0.5 * work);
  EXPECT_LT((ElementMissing<HexBbar, DruckerPrager>(drucker, &dissipated, &work)), 1e-12);
  EXPECT_GT(dissipated, 0.5 * work);
  EXPECT_LT((ElementMissing<HexOnePoint, DruckerPrager>(drucker, &dissipated, &work)), 1e-12);
  EXPECT_LT((ElementMissing<TetFull, MohrCoulomb>(mohr, &dissipated, &work)), 1e-12);
  EXPECT_LT((ElementMissing<HexFull, Breakage>(breakage, &dissipated, &work)), 1e-12);
  EXPECT_LT((ElementMissing<HexSpring, SpringBlock>(spring, &dissipated, &work)), 1e-12);
  const double leaky = ElementMissing<HexFull, Leaky>(mohr, &dissipated, &work);
  std::printf("    missing of the work: %.3g where nine tenths of the plastic strain are stored\n", leaky);
  EXPECT_GT(leaky, 1e-2);
}

}  // namespace
}  // namespace cdem
