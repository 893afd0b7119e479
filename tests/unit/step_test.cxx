// The step: batches, repeatability, conservation, prescribed motion, and that looking changes nothing.
#include "small_body.hpp"

#include <filesystem>
#include <unistd.h>

namespace cdem {
namespace {

void ExpectSame(const SceneResult &a, const SceneResult &b) {
  ASSERT_FALSE(a.failed || b.failed);
  EXPECT_TRUE(SameBits(a.u, b.u)) << RelativeDifference(a.u, b.u);
  EXPECT_TRUE(SameBits(a.v, b.v)) << RelativeDifference(a.v, b.v);
  ASSERT_EQ(a.history.size(), b.history.size());
  for (std::size_t g = 0; g < a.history.size(); ++g) {
    EXPECT_EQ(a.history[g].state, b.history[g].state);
    EXPECT_TRUE(SameBits(a.history[g].values, b.history[g].values));
  }
}

TEST(Step, BatchesAndRunsAreTheSameToTheLastBit) {
  for (const char *shape : {"hex", "tet", "wedge"}) {
    const std::string scene = BreakingScene(shape) +
                              " -boundaries zmin,zmax,xmax -boundary_xmax_traction 1e5,0,-2e4 -boundary_xmax_table r "
                              "-tables pulse,r -table_r_type ramp -table_r_delay 0.01 -damping_alpha 2 "
                              "-ts_max_steps 1100 -device cpu -ts_central_batch ";
    const SceneResult one = RunScene(scene + "1"), many = RunScene(scene + "1000"), odd = RunScene(scene + "73");
    EXPECT_GT(one.observed.broken, 0);
    EXPECT_LT(one.observed.broken, one.observed.springs);
    ExpectSame(one, many);
    ExpectSame(one, odd);
    ExpectSame(many, RunScene(scene + "1000"));
  }
}

TEST(Step, EveryLawBreaksAndRunsTheSameAgain) {
  for (const char *law : kBreakingLaws) {
    const std::string scene = BreakingScene("hex", law) + " -ts_max_steps 1500 -device cpu -ts_central_batch ";
    const SceneResult one = RunScene(scene + "1"), many = RunScene(scene + "1000");
    EXPECT_GT(one.observed.broken, 0.01 * one.observed.springs) << law;
    EXPECT_LT(one.observed.broken, one.observed.springs) << law;
    EXPECT_GT(one.observed.spring, 0);
    std::printf("    %-18s %.1f %% of the springs broken\n", law, 100 * one.observed.broken / one.observed.springs);
    ExpectSame(one, many);
    const int gap = std::string(law) == "brittle dilating"     ? JointBrittleDilating::kGap
                    : std::string(law) == "softening dilating" ? JointSofteningDilating::kGap
                                                               : -1;
    if (gap < 0) continue;
    const std::size_t n = one.history[0].state.size();
    double widest = 0;
    for (std::size_t i = 0; i < n; ++i) widest = std::max(widest, one.history[0].values[gap * n + i]);
    std::printf("    %-18s ridden up by %g m\n", law, widest);
    EXPECT_GT(widest, 0);
  }
}

TEST(Step, LookingChangesNothing) {
  const std::filesystem::path dir = std::filesystem::temp_directory_path() / ("cdem_step_" + std::to_string(getpid()));
  std::filesystem::create_directories(dir);
  const std::string scene = BreakingScene("wedge") + " -ts_max_steps 500 -device cpu";
  const SceneResult alone = RunScene(scene);
  const std::string at = " ascii:" + dir.string();
  const SceneResult watched =
      RunScene(scene + " -monitor_energy" + at + "/energy -monitor_energy_interval 7 -monitor_convergence" + at +
               "/convergence -monitor_convergence_interval 11 -monitor_progress" + at +
               "/progress -histories top -history_top_at "
               "3,3,4 -history_top_of velocity_x -output_interval 50 -output " +
               dir.string() + "/out");
  std::error_code ignored;
  const bool written = std::filesystem::exists(dir / "out" / "fields_000010.hdf", ignored) &&
                       std::filesystem::file_size(dir / "energy", ignored) > 70 * 20;
  EXPECT_TRUE(written) << "it has looked";
  std::filesystem::remove_all(dir, ignored);
  ExpectSame(alone, watched);
}

/// Sets the velocities of a scene that has not begun.
void SetVelocity(Simulation &scene, const std::function<double(std::size_t)> &value) {
  PetscScalar *v;
  ASSERT_PETSC(VecGetArray(scene.v(), &v));
  for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(scene.tables().n_owned); ++i) v[i] = value(i);
  ASSERT_PETSC(VecRestoreArray(scene.v(), &v));
}

// The energy form of the leapfrog, v(n-1/2).M v(n+1/2)/2 + u(n).K u(n)/2, over 1e5 steps at 0.9 of the exact critical step.
TEST(Step, EnergyFormIsHeldOver100000Steps) {
  const std::string scene = std::string(
                                "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_jitter 0.1 "
                                "-interfaces j -interface_j_on all -interface_j_stiffness_factor 5 "
                                "-boundaries zmin -boundary_zmin_fix xyz -device cpu -ts_central_check warn "
                                "-ts_max_steps 100000") +
                            kRock;
  const auto sizes = SetUpScene(scene, PETSC_COMM_SELF);
  ASSERT_NE(sizes, nullptr);
  std::vector<char> free_dof(sizes->tables().x.size());
  for (std::size_t i = 0; i < free_dof.size(); ++i) free_dof[i] = sizes->tables().x[i / 3 * 3 + 2] > 0;
  const double dt = 0.9 * CriticalStep(LargestW2(sizes->tables(), free_dof), 0);
  char step[40];
  std::snprintf(step, sizeof step, " -ts_dt %.15g", dt);
  const auto s = SetUpScene(scene + step, PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  SetVelocity(*s, [&](std::size_t) { return entry(random); });
  double first = 0, worst = 0;
  const double schedule[3] = {1, 1, 1};
  StepArgs next;
  next.dt = next.kick = s->dt();
  StepPlan plan;
  plan.dt = s->dt();
  for (PetscInt step_now = 0; step_now < 100000; step_now += plan.n) {
    plan.first = plan.offset = step_now;
    plan.n = step_now == 0 ? 1 : step_now == 1 ? 999 : 1000;
    ASSERT_PETSC(s->Advance(plan));
    plan.dt_old = plan.dt;
    Observed now;
    ASSERT_PETSC(s->backend().Observe(next, schedule, &now));
    if (step_now == 0) first = now.form;
    worst = std::max(worst, std::fabs(now.form / first - 1));
    if (step_now + plan.n == 100000) {
      EXPECT_GT(now.strain, 0);
      EXPECT_GT(now.spring, 0);
    }
  }
  std::printf("    energy form: %.1e\n", worst);
  EXPECT_GT(first, 0);
  EXPECT_LE(worst, 1e-12);
}

TEST(Step, MomentumOfAFreeBodyIsKept) {
  for (const char *shape : {"hex", "tet", "wedge"}) {
    std::string scene = BreakingScene(shape);  // its strengths, without what holds and pulls it
    scene.resize(scene.find(" -gravity"));
    const auto s = SetUpScene(scene + " -damping_beta 2e-5 -ts_max_steps 2000 -device cpu", PETSC_COMM_SELF);
    ASSERT_NE(s, nullptr);
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> entry(-1, 1);
    SetVelocity(*s, [&](std::size_t i) { return entry(random) * 0.5 + static_cast<double>(i % 3); });
    double start[3], end[3], size = 0;
    const auto momentum = [&](double p[3]) {
      const PetscScalar *v;
      std::fill_n(p, 3, 0.0);
      EXPECT_EQ(static_cast<int>(VecGetArrayRead(s->v(), &v)), 0);
      for (std::size_t i = 0; i < 3 * s->tables().mass.size(); ++i) p[i % 3] += s->tables().mass[i / 3] * v[i];
      EXPECT_EQ(static_cast<int>(VecRestoreArrayRead(s->v(), &v)), 0);
    };
    momentum(start);
    ASSERT_PETSC(s->Solve());
    momentum(end);
    for (double p : start) size = std::max(size, std::fabs(p));
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, std::fabs(end[k] - start[k]));
    std::printf("    %-5s momentum: %.1e\n", shape, most / size);
    EXPECT_LE(most, 1e-12 * size);
    Observed now;
    StepArgs next;
    next.dt = s->dt();
    ASSERT_PETSC(s->backend().Observe(next, nullptr, &now));
    EXPECT_GT(now.broken, 0);
    EXPECT_GT(now.strain, 0);
  }
}

// v stays what it was to the last bit, so there was no force; and u = v T says that the run ended at T.
TEST(Step, RigidTranslationIsForceFreeAndLandsOnTheEndTime) {
  for (const char *end : {" -ts_max_time 0.01", " -ts_max_time 0.01 -ts_dt 1.7e-5"})
    for (const char *shape : {"hex", "tet", "wedge"}) {
      const SceneResult r =
          RunScene(std::string("-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3 -mesh_box_jitter "
                               "0.2 -interfaces j -interface_j_on all -interface_j_law brittle "
                               "-interface_tension 0 -interface_cohesion 0 -interface_friction 30 "
                               "-velocity 1,-2,0.5 -device cpu -mesh_box_shape ") +
                   shape + kRock + end);
      ASSERT_FALSE(r.failed);
      const double v[3] = {1, -2, 0.5};
      for (std::size_t i = 0; i < r.v.size(); ++i) {
        ASSERT_EQ(r.v[i], v[i % 3]);
        ASSERT_NEAR(r.u[i], 0.01 * v[i % 3], 1e-13 * 0.02);
      }
      EXPECT_EQ(r.observed.force_sum, 0);
      EXPECT_EQ(r.observed.broken, 0);
    }
}

TEST(Step, PrescribedDisplacementIsReached) {
  const auto s = SetUpScene(std::string("-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 1,1,1 -boundaries zmin,zmax "
                                        "-boundary_zmin_fix xyz -boundary_zmax_displacement 1e-3,-2e-3,3e-3 "
                                        "-boundary_zmax_table r -tables r -table_r_type ramp -table_r_delay 0.02 "
                                        "-ts_max_time 0.015 -device cpu") +
                                kRock,
                            PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  ASSERT_PETSC(s->Solve());
  const PetscScalar *u;
  ASSERT_PETSC(VecGetArrayRead(s->u(), &u));
  const double top[3] = {1e-3, -2e-3, 3e-3};
  int n = 0;
  for (std::size_t i = 0; i < s->tables().x.size(); ++i) {
    const double z = s->tables().x[i / 3 * 3 + 2];
    if (z != 0 && z != 1) continue;
    EXPECT_NEAR(u[i], z * 0.75 * top[i % 3], 1e-15 * std::fabs(top[i % 3]));
    n += z == 1;
  }
  EXPECT_EQ(n, 27);
  ASSERT_PETSC(VecRestoreArrayRead(s->u(), &u));
}

TEST(Step, ARunThatLeavesTheNumbersStopsWithAnError) {
  const auto s = SetUpScene(std::string(kBrick) + " -ts_dt 1e-2 -ts_central_check off -ts_max_steps 2000 -device cpu",
                            PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  testing::internal::CaptureStderr();
  const PetscErrorCode code = s->Solve();
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, PETSC_ERR_USER_INPUT);
  for (const char *word : {"cdem: error: ", "unstable", "node at (", "step ", "-ts_dt"})
    EXPECT_NE(text.find(word), std::string::npos) << "no '" << word << "' in: " << text;
}

}  // namespace
}  // namespace cdem
