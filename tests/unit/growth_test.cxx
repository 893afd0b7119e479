// Runs whose energy grows beyond what comes in are stopped, and no others.
#include "../support/audit_run.hpp"
#include "core/order_free_sum.hpp"
#include "critical_scenes.hpp"

#include <algorithm>

namespace cdem {
namespace {

/// What Solve says, "" when it goes through.
std::string Complaint(const std::string &options) {
  const auto s = SetUpScene(options, PETSC_COMM_SELF);
  EXPECT_NE(s, nullptr);
  testing::internal::CaptureStderr();
  const PetscErrorCode code = s->Solve();
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(code != 0, !text.empty()) << text;
  return text;
}

// 1.001 of the exact step, nothing else wrong: caught in fewer than 5,000 steps, with the audit and without.
TEST(Growth, AThousandthAboveTheExactStepIsCaught) {
  int scenes = 0;
  for (const CriticalScene &scene : kCriticalScenes) {
    // one region here: tetrahedra that average would do so over other cells than in the body with its two
    const bool averages =
        std::string(scene.mesh).find("tet") != std::string::npos && std::string(scene.element) == "bbar";
    if (scene.soft != 1 || std::string(scene.element) == "spring" || averages) continue;
    SCOPED_TRACE(scene.name);
    Body body;
    const std::vector<char> free_dof = MakeScene(scene, &body);
    const double exact = CriticalStep(LargestW2(body.tables, free_dof), scene.beta);
    char numbers[400];
    const auto options = [&](double part) {
      std::snprintf(numbers, sizeof numbers,
                    " -block_young 1e10 -block_poisson %g -block_density 2500 -block_element %s -damping_beta %g "
                    "-ts_central_check off -ts_max_steps 4999 -ts_dt %.15g -device cpu",
                    scene.poisson, scene.element, scene.beta, part * exact);
      std::string all = std::string(scene.mesh) + numbers +
                        (scene.fixed ? " -boundaries zmin,zmax -boundary_zmin_fix xyz" : " -boundaries zmax") +
                        " -boundary_zmax_traction 1e4,2e4,5e4";
      if (scene.b > 0)
        all += " -interfaces j -interface_j_on all -interface_j_law elastic -interface_j_stiffness_factor " +
               std::to_string(scene.b);
      return all;
    };
    EXPECT_NE(Complaint(options(1.001)).find("unstable"), std::string::npos);
    if (++scenes % 4 > 0) continue;
    EXPECT_EQ(Complaint(options(0.999)), "");
    EXPECT_NE(Complaint(options(1.001) + kAuditOn).find("unstable"), std::string::npos);
  }
  EXPECT_GT(scenes, 15);
}

// A pulse far shorter than the time between two looks, from rest, in loads, motions and waves: nothing is wrong.
TEST(Growth, ShortPulsesAreLeftAlone) {
  const std::string pulse = " -tables p -table_p_type file -table_p_file " + PulseFile(2e-3) + " -ts_max_steps 9000";
  const std::string column =
      "-mesh box -mesh_box_cells 2,2,12 -mesh_box_size 2,2,12 -boundaries zmin,zmax -device cpu" + std::string(kRock);
  for (const char *load :
       {" -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,1e6 -boundary_zmax_table p",
        " -boundary_zmin_fix xyz -boundary_zmax_velocity 0.1,0,0.2 -boundary_zmax_table p",
        " -boundary_zmin_fix xyz -boundary_zmax_displacement 1e-4,0,1e-4 -boundary_zmax_table p",
        " -boundary_zmax_fix xyz -boundary_zmin_quiet -boundary_zmin_velocity 0.1,0,0.2 -boundary_zmin_table p"})
    EXPECT_EQ(Complaint(column + load + pulse), "") << load;
}

// The stop says step, place and cause, and leaves the last good state as a frame and a checkpoint to go on from.
TEST(Growth, TheLastGoodStateIsOnTheDisk) {
  const std::string dir = OwnFile("cdem_growth");
  std::filesystem::remove_all(dir);
  // at rest until after the first look
  const std::string scene =
      "-mesh box -mesh_box_cells 2,2,1 -mesh_box_size 2,2,1 -interfaces j -interface_j_on all "
      "-interface_j_law elastic -boundaries xmax -boundary_xmax_traction 1e3,2e3,5e2 -device cpu "
      "-ts_max_steps 20000" +
      std::string(kRock);
  double dt = 0;
  {
    const auto s = SetUpScene(scene, PETSC_COMM_SELF);
    ASSERT_NE(s, nullptr);
    dt = 1.01 * s->dt_critical();
  }
  char step[60];
  std::snprintf(step, sizeof step, " -ts_central_check off -ts_dt %.15g", dt);
  const std::string pulse =
      " -boundary_xmax_table p -tables p -table_p_type file -table_p_file " + PulseFile(20 * dt, 3000 * dt);
  const std::string text = Complaint(scene + step + pulse + " -output " + dir);
  for (const char *word :
       {"unstable", "step ", "(", "Likely cause: a time step above", "last good state, of step 2000"})
    EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
  EXPECT_TRUE(std::filesystem::exists(dir + "/fields_000001.hdf"));
  EXPECT_TRUE(std::filesystem::exists(dir + "/checkpoint_2000.h5"));
  // and goes on from there with a sound step
  std::snprintf(step, sizeof step, " -ts_dt %.15g", 0.5 * dt);
  EXPECT_EQ(Complaint(scene + step + pulse + " -restart " + dir + "/checkpoint_2000.h5"), "");
  std::filesystem::remove_all(dir);
}

TEST(OrderFreeSum, IsTheSameInAnyOrder) {
  std::vector<double> values;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) values.push_back(normal(random) * std::pow(10, 8 * normal(random)));
  std::vector<double> first, other;
  long double exact = 0;
  for (double v : values) exact += v;
  ASSERT_PETSC(SumInAnyOrder(PETSC_COMM_SELF, {{{values.data(), nullptr, values.size()}}}, &first));
  for (int i = 0; i < 20; ++i) {
    std::shuffle(values.begin(), values.end(), random);
    const std::size_t cut = random() % values.size();
    ASSERT_PETSC(SumInAnyOrder(PETSC_COMM_SELF,
                               {{{values.data(), nullptr, cut}, {values.data() + cut, nullptr, values.size() - cut}}},
                               &other));
    EXPECT_EQ(first[0], other[0]);
  }
  double largest = 0;
  for (double v : values) largest = std::max(largest, std::fabs(v));
  EXPECT_NEAR(first[0], static_cast<double>(exact), 1e-15 * largest);
  values[7] = std::nan("");
  ASSERT_PETSC(SumInAnyOrder(PETSC_COMM_SELF, {{{values.data(), nullptr, values.size()}}}, &other));
  EXPECT_TRUE(std::isnan(other[0]));
}

}  // namespace
}  // namespace cdem
