// The way `assembled` on the GPU against the reference way there.
#include "../support/run_scene.hpp"

namespace cdem {
namespace {

std::string LoadedBox(const std::string &shape) {
  return std::string("-mesh box -mesh_box_jitter 0.2 -mesh_box_size 5,4,3 -mesh_box_cells 9,9,9 -mesh_box_shape ") +
         shape + kRock +
         " -boundaries zmin,zmax,xmax -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r "
         "-boundary_xmax_displacement 0.001,0,0 -boundary_xmax_components x -boundary_xmax_table r -tables r "
         "-table_r_type ramp -table_r_delay 0.01 -gravity 0,0,-9.81 -ts_max_steps 501 -device cuda";
}

TEST(Gpu, AssembledIsTheReferenceWay) {
  for (const char *shape : {"hex", "tet", "wedge"})
    for (const char *more :
         {"", " -damping_alpha 5 -damping_beta 1e-5", " -interfaces j -interface_j_on all -interface_j_law elastic",
          " -interfaces j -interface_j_on all -interface_j_law elastic -damping_beta 1e-5"}) {
      const std::string scene = LoadedBox(shape) + more;
      SCOPED_TRACE(scene);
      const SceneResult reference = RunScene(scene + " -deterministic"),
                        got = RunScene(scene + " -central_way assembled"),
                        again = RunScene(scene + " -central_way assembled -ts_central_batch 7");
      EXPECT_LT(RelativeDifference(got.u, reference.u), 1e-10);
      EXPECT_LT(RelativeDifference(got.v, reference.v), 1e-10);
      EXPECT_LT(RelativeDifference(again.u, reference.u), 1e-10);
      EXPECT_NEAR(got.observed.strain, reference.observed.strain, 1e-9 * reference.observed.strain);
    }
}

TEST(Gpu, AssembledSaysWhatItIs) {
  std::unique_ptr<Simulation> s = SetUpScene(LoadedBox("hex") + " -central_way assembled");
  ASSERT_TRUE(s);
  EXPECT_EQ(s->backend().WayOfStep().name, "assembled");
  const long long nonzeros = 9 * 28 * 28 * 28;  // couplings of a box: 3 n - 2 along each axis of n nodes
  EXPECT_NE(s->backend().WayOfStep().text.find(std::to_string(nonzeros) + " nonzeros"), std::string::npos)
      << s->backend().WayOfStep().text;
  EXPECT_NE(s->backend().WayOfStep().text.find("cusparse"), std::string::npos);
  EXPECT_GT(s->backend().Bytes(), static_cast<std::size_t>(12 * nonzeros));
}

TEST(Gpu, AssembledRefusesWhatIsNotLinear) {
  for (const char *more : {" -interfaces j -interface_j_on all -interface_j_law brittle -interface_j_tension 1e5 "
                           "-interface_j_cohesion 1e6 "
                           "-interface_j_friction 30",
                           " -damping_local 0.5"}) {
    testing::internal::CaptureStderr();
    EXPECT_FALSE(SetUpScene(LoadedBox("hex") + " -central_way assembled" + more));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("-central_way assembled: this scene cannot go that way"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace cdem
