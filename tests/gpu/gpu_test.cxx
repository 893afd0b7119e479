// CPU against GPU: the same scenes on both, to 1e-10 in normal builds and to the last bit without contraction.
#include "../support/quiet_scene.hpp"

#include <cmath>

namespace cdem {
namespace {

#ifdef CDEM_NO_CONTRACT
constexpr bool kExact = true;
#else
constexpr bool kExact = false;
#endif

/// Figures for the docs: printed, so that a run of the tests states them.
void RecordedFigures(double u, double v, double broken) {
  std::printf("    u %.3e  v %.3e relative difference of GPU and CPU, %.2f %% of the springs broken\n", u, v,
              100 * broken);
}

void Compare(const std::string &scene, double bar) {
  // in the order of the global numbers: the partition may change from run to run
  const std::string way = kExact ? " -deterministic" : "", cuda = scene + way + " -device cuda";
  const SceneResult cpu = RunScene(scene + way + " -device cpu", PETSC_COMM_WORLD, true);
  const SceneResult gpu = RunScene(cuda, PETSC_COMM_WORLD, true);
  const SceneResult again = RunScene(cuda, PETSC_COMM_WORLD, true);
  PetscMPIInt ranks;
  ASSERT_EQ(MPI_Comm_size(PETSC_COMM_WORLD, &ranks), 0);
  ASSERT_FALSE(cpu.failed || gpu.failed || again.failed);
  ASSERT_GT(cpu.observed.u_max2, 0);
  EXPECT_TRUE(SameBits(gpu.u, again.u)) << "run = run on the GPU";
  EXPECT_TRUE(SameBits(gpu.v, again.v));
  const double u = RelativeDifference(gpu.u, cpu.u), v = RelativeDifference(gpu.v, cpu.v);
  RecordedFigures(u, v, cpu.observed.broken / std::max(1.0, cpu.observed.springs));
  if (kExact) {
    EXPECT_TRUE(SameBits(gpu.u, cpu.u)) << "relative difference " << u;
    EXPECT_TRUE(SameBits(gpu.v, cpu.v)) << "relative difference " << v;
    for (std::size_t g = 0; ranks == 1 && g < cpu.elements.size(); ++g) {
      EXPECT_EQ(gpu.elements[g].state, cpu.elements[g].state);
      EXPECT_TRUE(SameBits(gpu.elements[g].value, cpu.elements[g].value));
    }
    for (std::size_t g = 0; ranks == 1 && g < cpu.history.size(); ++g) {
      EXPECT_EQ(gpu.history[g].state, cpu.history[g].state);
      EXPECT_TRUE(SameBits(gpu.history[g].values, cpu.history[g].values));
    }
    for (std::size_t g = 0; ranks == 1 && g < cpu.elements.size(); ++g) {
      EXPECT_EQ(gpu.elements[g].state, cpu.elements[g].state);
      EXPECT_TRUE(SameBits(gpu.elements[g].value, cpu.elements[g].value));
      EXPECT_TRUE(SameBits(gpu.elements[g].broken_time, cpu.elements[g].broken_time));
    }
  } else {
    EXPECT_LT(u, bar);
    EXPECT_LT(v, bar);
  }
  EXPECT_EQ(gpu.observed.broken_elements, cpu.observed.broken_elements);
  // sums of an observation: another order of adding, so to rounding
  EXPECT_NEAR(gpu.observed.kinetic, cpu.observed.kinetic, 1e-9 * cpu.observed.kinetic);
  EXPECT_NEAR(gpu.observed.strain, cpu.observed.strain, 1e-9 * cpu.observed.strain);
  EXPECT_NEAR(gpu.observed.spring, cpu.observed.spring, 1e-9 * cpu.observed.spring + 1e-300);
  EXPECT_NEAR(gpu.observed.force_sum, cpu.observed.force_sum, 1e-9 * cpu.observed.force_sum);
  EXPECT_NEAR(gpu.observed.residual_sum, cpu.observed.residual_sum, 1e-8 * cpu.observed.residual_sum);
}

TEST(CpuGpu, Brick8000Steps) { Compare(std::string(kBrick) + " -ts_max_steps 8000", 1e-10); }

// Scenes that go by rows, against the reference way on the same GPU: loads and boundaries with tables, both dampings,
// springs, every shape and form; and in batches of any length the same to the last bit.
TEST(Gpu, RowsAreTheReferenceWay) {
  const char *const joints = " -interfaces j -interface_j_on all -interface_j_law elastic";
  const char *const load =
      " -boundaries zmin,zmax,xmax -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r "
      "-boundary_xmax_displacement 0.001,0,0 -boundary_xmax_components x -boundary_xmax_table r -tables r "
      "-table_r_type "
      "ramp -table_r_delay 0.01 -gravity 0,0,-9.81";
  int rows = 0;
  for (const char *damping : {"", " -damping_alpha 5", " -damping_alpha 5 -damping_beta 1e-5"})
    for (const char *body :
         {" -mesh_box_shape hex", " -mesh_box_shape tet", " -mesh_box_shape wedge",
          " -mesh_box_shape hex -block_element bbar", " -mesh_box_shape hex -block_element onepoint"})
      for (const char *more : {"", joints})
        for (const char *cells : {"5,4,3", "2,1,1", "9,9,9"}) {
          const std::string scene =
              std::string("-mesh box -mesh_box_jitter 0.2 -mesh_box_size 5,4,3 -mesh_box_cells ") + cells + body +
              more + load + damping + kRock + " -ts_max_steps 501 -device cuda";
          std::unique_ptr<Simulation> s = SetUpScene(scene);
          ASSERT_TRUE(s);
          if (s->backend().WayOfStep().name != "rows") continue;
          ++rows;
          SCOPED_TRACE(scene);
          const SceneResult reference = RunScene(scene + " -deterministic"), fast = RunScene(scene),
                            again = RunScene(scene + " -ts_central_batch 7");
          EXPECT_LT(RelativeDifference(fast.u, reference.u), 1e-10);
          EXPECT_LT(RelativeDifference(fast.v, reference.v), 1e-10);
          EXPECT_TRUE(SameBits(fast.u, again.u) && SameBits(fast.v, again.v)) << "batches do not matter";
        }
  EXPECT_GE(rows, 50);
}

TEST(CpuGpu, ShapesAndDamping) {
  for (const char *shape : {"hex", "tet", "wedge"})
    Compare(std::string("-mesh box -mesh_box_shape ") + shape +
                " -mesh_box_cells 5,4,3 -mesh_box_size 5,4,3 "
                "-mesh_box_jitter 0.2 -ts_max_steps 500 -boundaries zmin,zmax,xmax -boundary_zmin_fix xyz "
                "-boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r -boundary_xmax_displacement 0.001,0,0 "
                "-boundary_xmax_components x -boundary_xmax_table r -tables r -table_r_type ramp -table_r_delay 0.01 "
                "-damping_alpha 5 -damping_beta 1e-5" +
                kRock,
            1e-10);
}

TEST(CpuGpu, QuietBoundaries) {
  for (const char *shape : {"hex", "tet", "wedge"}) Compare(QuietScene(shape, "-ts_max_steps 1000"), 1e-10);
  Compare(QuietScene("hex", "-damping_beta 2e-5 -ts_max_steps 1000"), 1e-10);
}

TEST(CpuGpu, ElementForms) {
  for (const std::string &scene : FormScenes()) {
    // what breaks parts normal builds: there the springs stay below their strength
    const bool strong = !kExact && scene.find("spring") != std::string::npos;
    Compare(scene + " -ts_max_steps 500" + (strong ? " -block_tension 1e12 -block_cohesion 1e12" : ""), 1e-10);
  }
}

TEST(CpuGpu, ElasticJoints) { Compare(BreakingScene("hex", "elastic") + " -ts_max_steps 500", 1e-10); }

// Normal builds part after the first break, where exact ties amplify rounding: there the share of broken springs counts.
void CompareBreaking(const std::string &scene) {
  if (kExact) {
    Compare(scene, 0);
    return;
  }
  const SceneResult cpu = RunScene(scene + " -device cpu"), gpu = RunScene(scene + " -device cuda");
  ASSERT_FALSE(cpu.failed || gpu.failed);
  EXPECT_GT(cpu.observed.broken, 0) << "the scene must break";
  EXPECT_NEAR(gpu.observed.broken / gpu.observed.springs, cpu.observed.broken / cpu.observed.springs, 0.05);
}

TEST(CpuGpu, Breaking) {
  for (const char *shape : {"hex", "tet", "wedge"}) CompareBreaking(BreakingScene(shape) + " -ts_max_steps 2000");
}

TEST(CpuGpu, EveryLawThatBreaks) {
  for (const char *law : kBreakingLaws)
    for (const char *shape : {"hex", "tet"}) {
      SCOPED_TRACE(law);
      CompareBreaking(BreakingScene(shape, law) + " -ts_max_steps 2000");
    }
}

TEST(CpuGpu, FailingBlocks) {
  for (const char *law : kFailingLaws)
    for (const char *shape : {"hex", "tet", "wedge"})
      for (const char *beta : {"", " -damping_beta 2e-5"}) {
        const std::string scene = FailingScene(shape, law) + beta + " -ts_max_steps 2000";
        SCOPED_TRACE(scene);
        if (kExact) {
          Compare(scene, 0);
          continue;
        }
        const SceneResult cpu = RunScene(scene + " -device cpu"), gpu = RunScene(scene + " -device cuda"),
                          again = RunScene(scene + " -device cuda");
        ASSERT_FALSE(cpu.failed || gpu.failed || again.failed);
        EXPECT_TRUE(SameBits(gpu.u, again.u)) << "run = run on the GPU";
        EXPECT_GT(Touched(cpu), 50) << "the scene must fail";
        EXPECT_NEAR(Touched(gpu), Touched(cpu), 0.1 * Touched(cpu));
        EXPECT_NEAR(gpu.observed.broken_elements, cpu.observed.broken_elements, 0.1 * cpu.observed.broken_elements);
      }
}

TEST(CpuGpu, BrokenBlocksReleaseTheirInterfaces) {
  for (const char *shape : {"hex", "tet", "wedge"}) {
    const std::string scene = ReleasingScene(shape) + " -ts_max_steps 800";
    SCOPED_TRACE(scene);
    CompareBreaking(scene);
    EXPECT_GT(RunScene(scene + " -device cuda").observed.broken_elements, 0);
  }
}

std::string RelaxingScene(const std::string &damping) {
  return std::string(
             "-mesh box -mesh_box_cells 3,3,6 -mesh_box_size 3,3,6 -mesh_box_jitter 0.2 -gravity 0,0,-9.81 "
             "-boundaries zmin -boundary_zmin_fix xyz -interfaces j -interface_j_on all -interface_j_law brittle "
             "-interface_j_tension 1e8 -interface_j_cohesion 1e8 -interface_j_friction 30 -damping_beta 1e-5 "
             "-solve relax -relax_damping ") +
         damping + kRock;
}

TEST(CpuGpu, Relaxation) {
  for (const char *damping : {"rayleigh", "local", "combined", "kinetic"}) {
    SCOPED_TRACE(damping);
    const SceneResult cpu = RunScene(RelaxingScene(damping) + " -device cpu"),
                      gpu = RunScene(RelaxingScene(damping) + " -device cuda");
    ASSERT_FALSE(cpu.failed || gpu.failed);
    EXPECT_LE(RelativeDifference(gpu.u, cpu.u), kExact ? 0 : 1e-5);
  }
}

TEST(CpuGpu, BlocksUpToTheirStrength) {
  for (const char *law : kFailingLaws) {
    const std::string scene =
        FailingScene("hex", law) + " -ts_dt 5e-6";  // it fails within three steps of the usual size
    int steps = 1000;                               // the longest run of this scene in which nothing fails
    while (steps > 1 && Touched(RunScene(scene + " -device cpu -ts_max_steps " + std::to_string(steps))) > 0)
      steps /= 2;
    ASSERT_GT(steps, 10);
    Compare(scene + " -ts_max_steps " + std::to_string(steps), 1e-10);
  }
}

TEST(CpuGpu, JointedUpToTheFirstBreak) {
  const std::string scene = BreakingScene("hex") + " -ts_central_safety 0.3";
  int steps = 1000;  // the longest run of this scene in which nothing breaks
  while (steps > 1 && RunScene(scene + " -device cpu -ts_max_steps " + std::to_string(steps)).observed.broken > 0)
    steps /= 2;
  ASSERT_GT(steps, 10);
  Compare(scene + " -ts_max_steps " + std::to_string(steps), 1e-10);
}

// Run with mpirun -n 2 and -n 3 (ctest does): the ranks share the GPU, or have one each.
TEST(GpuRanks, DoNotMatter) {
  for (const char *shape : {"hex", "tet", "wedge"})
    ExpectRanksDoNotMatter(BreakingScene(shape) + " -ts_max_steps 1000 -device cuda");
  for (const char *law : kBreakingLaws)
    ExpectRanksDoNotMatter(BreakingScene("hex", law) + " -ts_max_steps 1000 -device cuda");
  ExpectRanksDoNotMatter(std::string(kBrick) + " -ts_max_steps 1000 -device cuda");
  for (const char *law : kFailingLaws)
    ExpectRanksDoNotMatter(FailingScene("hex", law) + " -ts_max_steps 1000 -device cuda");
  for (const std::string &scene : FormScenes()) ExpectRanksDoNotMatter(scene + " -ts_max_steps 500 -device cuda");
  ExpectRanksDoNotMatter(ReleasingScene("hex") + " -ts_max_steps 800 -device cuda");
  for (const char *damping : {"rayleigh", "kinetic"}) ExpectRanksDoNotMatter(RelaxingScene(damping) + " -device cuda");
  ExpectRanksDoNotMatter(QuietScene("hex", "-ts_max_steps 500 -device cuda"));
}

TEST(Gpu, BatchesDoNotMatter) {
  const std::string scene = BreakingScene("hex") + " -ts_max_steps 700 -device cuda -ts_central_batch ";
  const SceneResult one = RunScene(scene + "1"), many = RunScene(scene + "1000"), odd = RunScene(scene + "73");
  EXPECT_TRUE(SameBits(one.u, many.u));
  EXPECT_TRUE(SameBits(one.v, many.v));
  EXPECT_TRUE(SameBits(one.u, odd.u));
}

TEST(Gpu, NonFiniteStops) {
  std::unique_ptr<Simulation> s =
      SetUpScene(std::string(kBrick) + " -ts_max_steps 3000 -device cuda -ts_dt 0.002 -ts_central_check warn");
  ASSERT_NE(s, nullptr);
  EXPECT_NE(static_cast<int>(s->Solve()), 0);
}

TEST(Gpu, VectorsAreCudaVectors) {
  std::unique_ptr<Simulation> s = SetUpScene(std::string(kBrick) + " -ts_max_steps 10 -device cuda");
  ASSERT_NE(s, nullptr);
  PetscBool cuda;
  ASSERT_PETSC(
      PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(s->u()), &cuda, VECCUDA, VECSEQCUDA, VECMPICUDA, ""));
  EXPECT_TRUE(cuda);
  ASSERT_PETSC(s->Solve());
  PetscReal norm;
  ASSERT_PETSC(VecNorm(s->u(), NORM_2, &norm));
  EXPECT_GT(norm, 0);
}

}  // namespace
}  // namespace cdem
