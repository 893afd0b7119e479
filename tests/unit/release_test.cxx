// Elements that break and release their interfaces.
#include "../support/run_scene.hpp"

#include <gtest/gtest.h>

namespace cdem {
namespace {

/// A column of four elements, every face an interface that is stronger than the rock; the top is pulled.
std::string Column(bool release) {
  return std::string(
             "-mesh box -mesh_box_cells 1,1,4 -mesh_box_size 1,1,4 -block_law breakage -block_tension 1e5 "
             "-block_cohesion 1e6 -block_friction 30 -interfaces j -interface_j_on all -interface_j_law brittle "
             "-interface_j_tension 1e8 -interface_j_cohesion 1e9 -interface_j_friction 30 -boundaries zmin,zmax "
             "-boundary_zmin_fix xyz -boundary_zmax_velocity 0,0,0.1 -device cpu") +
         kRock + (release ? " -block_release_interfaces" : "");
}

TEST(Release, SpringsBreakWithTheirElements) {
  const SceneResult held = RunScene(Column(false) + " -ts_max_steps 400"),
                    released = RunScene(Column(true) + " -ts_max_steps 400");
  EXPECT_GT(held.observed.broken_elements, 0);
  EXPECT_EQ(held.observed.broken, 0);
  EXPECT_GT(released.observed.broken_elements, 0);
  EXPECT_GT(released.observed.broken, 0);
}

TEST(Release, OnlyOnTheFacesOfBrokenElements) {
  // the shortest run in which something has broken: the springs of one broken element's faces, and no others
  for (int steps = 1; steps < 400; ++steps) {
    const SceneResult r = RunScene(Column(true) + " -ts_max_steps " + std::to_string(steps));
    std::vector<int> broken;
    for (std::size_t e = 0; e < r.elements[0].state.size(); ++e)
      if (r.elements[0].state[e] & (kBrokenTension | kBrokenShear)) broken.push_back(static_cast<int>(e));
    if (broken.empty()) {
      for (std::uint8_t state : r.history[0].state) ASSERT_EQ(state & kCohesionLost, 0);
      continue;
    }
    for (std::size_t i = 0; i < r.history[0].state.size(); ++i) {
      const int face = static_cast<int>(i) / 4;  // between elements face and face + 1
      const bool beside =
          std::count(broken.begin(), broken.end(), face) + std::count(broken.begin(), broken.end(), face + 1) > 0;
      EXPECT_EQ((r.history[0].state[i] & kCohesionLost) != 0, beside) << "spring " << i;
    }
    return;
  }
  FAIL() << "nothing broke";
}

TEST(ReleaseRanks, DoNotMatter) { ExpectRanksDoNotMatter(ReleasingScene("hex") + " -ts_max_steps 800 -device cpu"); }

}  // namespace
}  // namespace cdem
