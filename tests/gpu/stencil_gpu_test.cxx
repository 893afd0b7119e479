// The way of stencils on the GPU against the reference way there, and against itself on the CPU.
#include "../support/run_scene.hpp"

namespace cdem {
namespace {

TEST(Gpu, StencilIsTheReferenceWay) {
  const char *const joints = " -interfaces j -interface_j_on all -interface_j_law elastic";
  const char *const load =
      " -boundaries zmin,zmax,xmax -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r "
      "-boundary_xmax_displacement 0.001,0,0 -boundary_xmax_components x -boundary_xmax_table r -tables r "
      "-table_r_type ramp -table_r_delay 0.01 -gravity 0,0,-9.81 -histories top -history_top_at 2.5,2,3 "
      "-history_top_of displacement_z";
  for (const char *damping : {"", " -damping_alpha 5", " -damping_alpha 5 -damping_beta 1e-5"})
    for (const char *shape : {"hex", "tet", "wedge"})
      for (const char *more : {"", joints})
        for (const char *cells : {"10,8,6", "24,20,16"}) {
          const std::string scene = std::string("-mesh box -mesh_box_size 5,4,3 -mesh_box_cells ") + cells +
                                    " -mesh_box_shape " + shape + more + load + damping + kRock + " -ts_max_steps 301";
          SCOPED_TRACE(scene);
          const std::string gpu = scene + " -device cuda";
          const SceneResult reference = RunScene(gpu + " -deterministic"),
                            fast = RunScene(gpu + " -central_way stencil"),
                            again = RunScene(gpu + " -central_way stencil -ts_central_batch 7"),
                            cpu = RunScene(scene + " -device cpu -central_way stencil");
          EXPECT_LT(RelativeDifference(fast.u, reference.u), 1e-10);
          EXPECT_LT(RelativeDifference(fast.v, reference.v), 1e-10);
          EXPECT_LT(RelativeDifference(fast.u, cpu.u), 1e-10);
          EXPECT_TRUE(SameBits(fast.u, again.u) && SameBits(fast.v, again.v)) << "batches do not matter";
        }
}

// Many nodes of a thread, and the choice of the way by itself.
TEST(Gpu, StencilOfALargeScene) {
  const std::string scene =
      std::string("-mesh box -mesh_box_size 80,80,70 -mesh_box_cells 80,80,70") + kRock +
      " -gravity 0,0,-9.81 -boundaries zmin -boundary_zmin_fix xyz -ts_max_steps 100 -device cuda";
  std::unique_ptr<Simulation> s = SetUpScene(scene);
  ASSERT_TRUE(s);
  EXPECT_EQ(s->backend().WayOfStep().name, "stencil");
  s.reset();
  const SceneResult reference = RunScene(scene + " -deterministic"), fast = RunScene(scene);
  EXPECT_LT(RelativeDifference(fast.u, reference.u), 1e-10);
  EXPECT_LT(RelativeDifference(fast.v, reference.v), 1e-10);
}

}  // namespace
}  // namespace cdem
