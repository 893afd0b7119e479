// The way `assembled` against the reference way, and the scenes that cannot go it.
#include "../support/run_scene.hpp"

#include <gtest/gtest.h>

namespace cdem {
namespace {

const char *const kAssembled = " -central_way assembled";

std::string LoadedBox(const std::string &shape) {
  return std::string("-mesh box -mesh_box_jitter 0.2 -mesh_box_size 5,4,3 -mesh_box_cells 5,4,3 -mesh_box_shape ") +
         shape + kRock +
         " -boundaries zmin,zmax,xmax -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r "
         "-boundary_xmax_displacement 0.001,0,0 -boundary_xmax_components x -boundary_xmax_table r -tables r "
         "-table_r_type "
         "ramp -table_r_delay 0.01 -gravity 0,0,-9.81 -ts_max_steps 400 -device cpu";
}

TEST(Assembled, IsTheReferenceWay) {
  for (const char *shape : {"hex", "tet", "wedge"})
    for (const char *more :
         {"", " -damping_alpha 5 -damping_beta 1e-5", " -interfaces j -interface_j_on all -interface_j_law elastic",
          " -interfaces j -interface_j_on all -interface_j_law elastic -damping_beta 1e-5"}) {
      const std::string scene = LoadedBox(shape) + more;
      SCOPED_TRACE(scene);
      const SceneResult reference = RunScene(scene, PETSC_COMM_SELF),
                        got = RunScene(scene + kAssembled, PETSC_COMM_SELF);
      ASSERT_GT(reference.observed.u_max2, 0);
      EXPECT_LT(RelativeDifference(got.u, reference.u), 1e-10);
      EXPECT_LT(RelativeDifference(got.v, reference.v), 1e-10);
      EXPECT_NEAR(got.observed.strain, reference.observed.strain, 1e-9 * reference.observed.strain);
    }
}

TEST(Assembled, Forms) {
  for (const char *form : {"bbar", "onepoint"}) {
    const std::string scene = LoadedBox("hex") + " -block_element " + form;
    EXPECT_LT(RelativeDifference(RunScene(scene + kAssembled, PETSC_COMM_SELF).u, RunScene(scene, PETSC_COMM_SELF).u),
              1e-10);
  }
}

TEST(Assembled, AnyMatrix) {
  const SceneResult reference = RunScene(LoadedBox("hex"), PETSC_COMM_SELF);
  for (const char *type : {"aij", "baij", "sbaij", "seqaij"}) {
    SCOPED_TRACE(type);
    const std::string scene = LoadedBox("hex") + kAssembled + " -central_mat_type " + type;
    EXPECT_LT(RelativeDifference(RunScene(scene, PETSC_COMM_SELF).u, reference.u), 1e-10);
  }
}

TEST(Assembled, HeaderSaysWhatItIs) {
  std::unique_ptr<Simulation> plain = SetUpScene(LoadedBox("hex"), PETSC_COMM_SELF);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->backend().WayOfStep().name, "reference");
  const std::size_t bytes = plain->backend().Bytes();
  std::unique_ptr<Simulation> s = SetUpScene(LoadedBox("hex") + kAssembled, PETSC_COMM_SELF);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->backend().WayOfStep().name, "assembled");
  // couplings of a box: 3 n - 2 along each axis of n nodes
  const long long nonzeros = 9 * (3 * 6 - 2) * (3 * 5 - 2) * (3 * 4 - 2);
  EXPECT_NE(s->backend().WayOfStep().text.find(std::to_string(nonzeros) + " nonzeros"), std::string::npos)
      << s->backend().WayOfStep().text;
  EXPECT_GT(s->backend().Bytes(), bytes + 8 * nonzeros);
}

TEST(Assembled, RefusesWhatIsNotLinear) {
  const std::pair<const char *, const char *> refused[] = {
      {" -interfaces j -interface_j_on all -interface_j_law brittle -interface_j_tension 1e5 -interface_j_cohesion 1e6 "
       "-interface_j_friction 30",
       "interfaces that are not linear"},
      {" -block_law drucker_prager -block_cohesion 1e6 -block_friction 30 -block_tension 1e5",
       "blocks that are not linear"},
      {" -damping_local 0.5", "damping of nodes"},
      {" -monitor_energy", "-monitor_energy"},
      {" -deterministic", "leave one of them out"},
      {" -central_mat_type tartan", "no such matrix"}};
  for (const auto &[more, words] : refused) {
    SCOPED_TRACE(more);
    testing::internal::CaptureStderr();
    EXPECT_FALSE(SetUpScene(LoadedBox("hex") + kAssembled + more, PETSC_COMM_SELF));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.find("cdem: error: "), 0u) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace cdem
