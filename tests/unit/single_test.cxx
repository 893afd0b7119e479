// Element arithmetic in single precision against that in double precision.
#include "../support/single_scenes.hpp"
#include "small_body.hpp"

#include <cfloat>

namespace cdem {
namespace {

/// Random displacements on top of a motion of the whole body, and velocities.
struct Motion {
  std::vector<double> u, v;
  Motion(const Tables &tables, double whole) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> entry(-1, 1);
    for (std::size_t i = 0; i < tables.x.size(); ++i) {
      u.push_back(whole + 1e-4 * entry(random));
      v.push_back(entry(random));
    }
  }
};

std::vector<double> Forces(const Tables &t, const Motion &m, bool single) {
  std::vector<double> f(m.u.size(), 0.0);
  std::vector<ElementHistories> none = StartElements(t);
  HostElements(t, m.u.data(), m.v.data(), t.beta, 0, none, f.data(), nullptr, single);
  return f;
}

TEST(Single, ForcesDifferByItsRounding) {
  double most = 0;
  for (const std::string &scene : SingleScenes()) {
    SCOPED_TRACE(scene);
    std::unique_ptr<Simulation> s = SetUpScene(scene + " -ts_max_steps 1 -device cpu", PETSC_COMM_SELF);
    ASSERT_TRUE(s);
    const Tables &t = s->tables();
    const Motion here(t, 0), away(t, 1000);
    const std::vector<double> exact = Forces(t, here, false), single = Forces(t, here, true);
    const double difference = RelativeDifference(single, exact);
    most = std::max(most, difference);
    EXPECT_LT(difference, 10 * FLT_EPSILON);
    EXPECT_GT(difference, 0.01 * FLT_EPSILON) << "it is single precision";
    // a body that has moved far as a whole: what the doubles have lost of its displacements, and no more
    EXPECT_LT(RelativeDifference(Forces(t, away, true), Forces(t, away, false)), 10 * FLT_EPSILON);
    Motion rigid(t, 0);
    std::fill(rigid.u.begin(), rigid.u.end(), 1000.1);
    std::fill(rigid.v.begin(), rigid.v.end(), 3.3);
    EXPECT_EQ(Largest(Forces(t, rigid, true)), 0);
  }
  std::printf("    forces: %.1e of the largest\n", most);
}

TEST(Single, RunsDifferByItsRounding) {
  for (const std::string &scene : SingleScenes()) {
    const std::string run = scene + " -device cpu -ts_max_steps 400";
    SCOPED_TRACE(run);
    if (run.find("brittle") != std::string::npos) continue;  // rounding may decide what breaks
    const SceneResult exact = RunScene(run, PETSC_COMM_SELF),
                      single = RunScene(run + " -precision single", PETSC_COMM_SELF),
                      batches = RunScene(run + " -precision single -ts_central_batch 7", PETSC_COMM_SELF);
    EXPECT_LT(RelativeDifference(single.u, exact.u), 1e-5);
    EXPECT_GT(RelativeDifference(single.u, exact.u), 1e-9);
    EXPECT_TRUE(SameBits(single.u, batches.u) && SameBits(single.v, batches.v)) << "batches do not matter";
  }
}

TEST(Single, ComesToRest) {
  const std::string scene = std::string(kBrick) + " -solve relax -relax_ratio 1e-6 -device cpu";
  const SceneResult exact = RunScene(scene, PETSC_COMM_SELF),
                    single = RunScene(scene + " -precision single", PETSC_COMM_SELF);
  EXPECT_LT(RelativeDifference(single.u, exact.u), 1e-5);
}

TEST(Single, TheSharpStepIsThatOfDoublePrecision) {
  const std::string scene = StruckScene("hex", "-ts_max_steps 1 -device cpu");
  const double dt = SetUpScene(scene, PETSC_COMM_SELF)->dt();
  EXPECT_EQ(SetUpScene(scene + " -precision single", PETSC_COMM_SELF)->dt(), dt);
}

TEST(Single, RefusesABalanceFinerThanItsRounding) {
  testing::internal::CaptureStderr();
  EXPECT_FALSE(SetUpScene(std::string(kBrick) + " -solve relax -device cpu -precision single"));
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("-relax_ratio 1e-07"), std::string::npos) << said;
}

TEST(Single, RefusesWhatItWouldSpoil) {
  for (const auto &[more, what] :
       {std::pair{" -block_law drucker_prager -block_cohesion 3e5 -block_friction 30 -block_tension 1e5",
                  "the law drucker_prager is not linear"},
        {" -block_stress 1e5,1e5,1e5,0,0,0", "under stress from the start"},
        {" -mesh_box_shape tet -block_element bbar", "tetrahedra of form bbar average"},
        {" -damping_beta 1e-5 -monitor_energy", "is kept in double precision"},
        {" -central_way stencil", "-central_way stencil"}}) {
    testing::internal::CaptureStderr();
    EXPECT_FALSE(SetUpScene(std::string(kBrick) + " -ts_max_steps 1 -device cpu -precision single" + more));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("-precision single"), std::string::npos) << said;
    EXPECT_NE(said.find(what), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace cdem
