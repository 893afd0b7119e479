// The cheap bound of the critical step against the exact one, from the dense stiffness matrix of small scenes.
#include "critical_scenes.hpp"
#include "forces/bound_parts.hpp"

namespace cdem {
namespace {

TEST(StepBound, IsBelowTheExactStepAndNotFarBelow) {
  std::printf("    %-34s %12s %12s %8s\n", "scene", "exact dt, s", "bound, s", "ratio");
  for (const CriticalScene &scene : kCriticalScenes) {
    SCOPED_TRACE(scene.name);
    Body body;
    const std::vector<char> free_dof = MakeScene(scene, &body);
    StepBound bound;
    ASSERT_PETSC(ComputeStepBound(body.tables, body.materials, &bound));
    const double exact = CriticalStep(LargestW2(body.tables, free_dof), scene.beta);
    std::printf("    %-34s %12.5e %12.5e %8.4f\n", scene.name, exact, bound.dt, bound.dt / exact);
    EXPECT_LE(bound.dt, exact);
    EXPECT_GE(bound.dt, scene.least * exact);
    if (scene.b == 0) {
      EXPECT_EQ(bound.spring_w2, 0);
    }
  }
}

// Elements and nodes that are left early are never those that give the bound.
TEST(StepBound, IsThatOfEveryElementAndNode) {
  for (const char *shape : {"hex", "wedge", "tet"})
    for (double jitter : {0.0, 0.15}) {
      SCOPED_TRACE(std::string(shape) + ", jitter " + std::to_string(jitter));
      Body body;
      body.Make(std::string("-mesh box -mesh_box_cells 7,6,5 -mesh_box_size 7,6,5 -mesh_box_shape ") + shape +
                " -mesh_box_jitter " + std::to_string(jitter));
      body.SplitAll();
      body.Build();
      StepBound bound;
      ASSERT_PETSC(ComputeStepBound(body.tables, body.materials, &bound));
      double element_w2 = 0, spring_w2 = 0;
      int element = -1;
      const ElementTable &t = body.tables.elements[0];
      VisitElement(t.shape, t.form, [&](auto form) {
        for (int e = 0; e < t.n; ++e) {
          Canonical batch[kLanes];
          MakeCanonical(body.tables, t, body.materials, e, &batch[0]);
          std::fill(batch + 1, batch + kLanes, batch[0]);
          const double w2 = LanesBound<decltype(form)>(batch)[0];
          if (w2 > element_w2) element_w2 = w2, element = e;
        }
      });
      const std::vector<std::array<double, 6>> sum = SpringStiffness(body.tables);
      for (int i = 0; i < body.tables.n_owned; ++i)
        spring_w2 = std::max(spring_w2, 2 * LargestEigenvalue(sum[i]) * body.tables.inverse_mass[i]);
      EXPECT_EQ(bound.element_w2, element_w2);
      EXPECT_EQ(bound.element[0], element);
      EXPECT_NEAR(bound.spring_w2, spring_w2, 1e-12 * spring_w2);
      EXPECT_EQ(SpringStiffness(body.tables, bound.node), sum[bound.node]);
    }
}

// Of an oscillator with damping 2 xi w = beta w^2: x(n+1) - x(n) = x(n) - x(n-1) - dt^2 w^2 x(n) - dt beta w^2 (x(n) - x(n-1))
// leaves the unit circle through -1 at dt^2 w^2 + 2 dt beta w^2 = 4.
TEST(StepBound, BetaLowersTheStep) {
  const double w2 = 3e6;
  EXPECT_DOUBLE_EQ(CriticalStep(w2, 0), 2 / std::sqrt(w2));
  for (double beta : {1e-6, 1e-4, 1e-2}) {
    const double dt = CriticalStep(w2, beta);
    EXPECT_NEAR(dt * dt * w2 + 2 * dt * beta * w2, 4, 1e-10);
  }
  EXPECT_TRUE(std::isinf(CriticalStep(0, 0)));
}

/// Whether the program's own run goes to its end at this step; else it must have been stopped for its energy.
bool GoesToItsEnd(const std::string &scene, double dt) {
  char step[80];
  std::snprintf(step, sizeof step, " -ts_central_check off -ts_dt %.15g", dt);
  const auto s = SetUpScene(scene + step, PETSC_COMM_SELF);
  EXPECT_NE(s, nullptr);
  testing::internal::CaptureStderr();
  const PetscErrorCode code = s->Solve();
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code != 0, text.find("the run became unstable") != std::string::npos) << text;
  return code == 0;
}

// The exact step is where the program itself turns unstable, with springs and beta.
TEST(StepBound, TheExactStepIsWhereTheRunTurns) {
  for (double beta : {0.0, 2e-5}) {
    Body body;
    body.Make("-mesh box -mesh_box_cells 2,2,1 -mesh_box_size 2,2,1");
    body.SplitAll();
    body.Build();
    const double dt = CriticalStep(LargestW2(body.tables, std::vector<char>(body.tables.x.size(), 1)), beta);
    char damping[40];
    std::snprintf(damping, sizeof damping, " -damping_beta %g", beta);
    const std::string scene = std::string(
                                  "-mesh box -mesh_box_cells 2,2,1 -mesh_box_size 2,2,1 -interfaces j "
                                  "-interface_j_on all -boundaries xmax -boundary_xmax_traction 1e3,2e3,5e2 "
                                  "-tables p -table_p_type ricker -table_p_frequency 2000 -table_p_delay 2e-4 "
                                  "-boundary_xmax_table p -device cpu") +
                              kRock + damping + " -ts_max_steps 5000";
    EXPECT_TRUE(GoesToItsEnd(scene, 0.999 * dt));
    EXPECT_FALSE(GoesToItsEnd(scene, 1.001 * dt)) << "the energy grows unseen";
  }
}

}  // namespace
}  // namespace cdem
