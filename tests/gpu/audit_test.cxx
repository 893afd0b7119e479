// The energy audit on the GPU: it closes there too, equals that of the CPU, and changes nothing of the run.
#include "../support/audit_run.hpp"
#include "../support/quiet_scene.hpp"

#include <cmath>

namespace cdem {
namespace {

#ifdef CDEM_NO_CONTRACT
constexpr bool kExact = true;
#else
constexpr bool kExact = false;
#endif

/// The scenes of all laws, forms and dampings.
std::vector<std::string> AuditScenes() {
  std::vector<std::string> scenes = FormScenes();
  for (const char *damping : {"", " -damping_beta 2e-5 -damping_alpha 10"}) {
    for (const char *law : kFailingLaws)
      for (const char *shape : {"hex", "tet", "wedge"}) scenes.push_back(FailingScene(shape, law) + damping);
    scenes.push_back(FailingScene("tet", "mohr_coulomb") + " -block_element bbar" + damping);
    for (const char *law : kBreakingLaws) scenes.push_back(BreakingScene("hex", law) + damping);
    scenes.push_back(ReleasingScene("hex") + damping);
  }
  scenes.push_back(FailingScene("hex", "drucker_prager") + " -damping_local 0.2");
  scenes.push_back(QuietScene("hex"));
  for (std::string &scene : scenes) scene += " -ts_max_steps 400 -deterministic -device ";
  return scenes;
}

TEST(GpuAudit, ClosesAndEqualsTheCpus) {
  for (const std::string &scene : AuditScenes()) {
    SCOPED_TRACE(scene);
    const AuditRun cpu(scene + "cpu"), gpu(scene + "cuda");
    ASSERT_GT(gpu.rows.size(), 6u);
    EXPECT_LT(gpu.WorstError(), 1e-10);
    const auto near = [&](double a, double b, const char *what) {
      // what breaks parts normal builds: shares, not digits
      EXPECT_NEAR(a, b, kExact ? 0 : 0.05 * cpu.last.Scale()) << what;
    };
    near(gpu.last.sums.kinetic, cpu.last.sums.kinetic, "kinetic");
    near(gpu.last.sums.strain, cpu.last.sums.strain, "strain");
    near(gpu.last.sums.spring, cpu.last.sums.spring, "spring");
    for (const BalanceTerm &term : kBalanceTerms)
      if (std::string(term.name) != "error") near(term.value(gpu.last), term.value(cpu.last), term.name);
  }
}

// Up to the first failure normal builds agree too.
TEST(GpuAudit, EqualsTheCpusInElasticBodies) {
  for (const char *shape : {"hex", "tet", "wedge"}) {
    const std::string scene = QuietScene(shape, "-damping_beta 2e-5 -damping_local 0.1 -ts_max_steps 500 -device ");
    const AuditRun cpu(scene + "cpu"), gpu(scene + "cuda");
    for (const BalanceTerm &term : kBalanceTerms)
      if (std::string(term.name) != "error") {
        // local damping follows the signs of velocities, where rounding shows
        EXPECT_NEAR(term.value(gpu.last), term.value(cpu.last), 1e-7 * cpu.last.Scale()) << term.name;
      }
  }
}

TEST(GpuAudit, TheRunIsTheSameWithoutIt) {
  for (const std::string &scene : AuditScenes()) {
    SCOPED_TRACE(scene);
    const SceneResult off = RunScene(scene + "cuda"), on = RunScene(scene + "cuda" + kAuditOn);
    EXPECT_TRUE(SameBits(on.u, off.u)) << RelativeDifference(on.u, off.u);
    EXPECT_TRUE(SameBits(on.v, off.v)) << RelativeDifference(on.v, off.v);
  }
}

TEST(GpuAudit, AnUnstableRunIsStopped) {
  for (const char *audit : {"", kAuditOn}) {
    std::unique_ptr<Simulation> s = SetUpScene(std::string(kBrick) + " -ts_max_steps 10 -device cuda");
    ASSERT_NE(s, nullptr);
    char step[80];
    std::snprintf(step, sizeof step, " -ts_max_steps 4999 -ts_central_check off -ts_dt %.15g", 1.02 * s->dt_critical());
    s = SetUpScene(std::string(kBrick) + " -device cuda" + step + audit);
    ASSERT_NE(s, nullptr);
    testing::internal::CaptureStderr();
    EXPECT_NE(static_cast<int>(s->Solve()), 0);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("unstable"), std::string::npos);
  }
}

// Run with mpirun -n 2 and -n 3 (ctest does): the ranks share the GPU, or have one each.
TEST(GpuAuditRanks, DoNotMatter) {
  for (const std::string &scene : {BreakingScene("hex", "softening") + " -damping_alpha 3",
                                   FailingScene("tet", "mohr_coulomb") + " -block_element bbar"}) {
    SCOPED_TRACE(scene);
    const AuditRun alone(scene + " -ts_max_steps 300 -device cuda", PETSC_COMM_SELF),
        together(scene + " -ts_max_steps 300 -device cuda", PETSC_COMM_WORLD);
    for (const BalanceTerm &term : kBalanceTerms)
      EXPECT_EQ(term.value(alone.last), term.value(together.last)) << term.name;
  }
}

}  // namespace
}  // namespace cdem
