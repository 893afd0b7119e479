// Ranks do not matter, to the last bit: run with mpirun -n 2 and -n 3 (ctest does).
#include "../support/quiet_scene.hpp"
#include "../support/single_scenes.hpp"

namespace cdem {
namespace {

TEST(Ranks, DoNotMatterWhenBreaking) {
  for (const char *shape : {"hex", "tet", "wedge"})
    ExpectRanksDoNotMatter(BreakingScene(shape) + " -ts_max_steps 1000 -device cpu");
}

TEST(Ranks, DoNotMatterToAnyLawThatBreaks) {
  for (const char *law : kBreakingLaws)
    ExpectRanksDoNotMatter(BreakingScene("wedge", law) + " -ts_max_steps 1000 -device cpu");
}

TEST(Ranks, DoNotMatterWhenBlocksFail) {
  for (const char *law : kFailingLaws) {
    for (const char *shape : {"hex", "tet", "wedge"})
      ExpectRanksDoNotMatter(FailingScene(shape, law) + " -ts_max_steps 600 -device cpu");
    ExpectRanksDoNotMatter(FailingScene("hex", law) + " -ts_max_steps 600 -damping_beta 2e-5 -device cpu");
  }
}

TEST(Ranks, DoNotMatterWhenJoined) { ExpectRanksDoNotMatter(std::string(kBrick) + " -ts_max_steps 500 -device cpu"); }

TEST(Ranks, DoNotMatterInAnyElementForm) {
  for (const std::string &scene : FormScenes()) ExpectRanksDoNotMatter(scene + " -ts_max_steps 500 -device cpu");
}

TEST(Ranks, DoNotMatterToQuietBoundaries) {
  for (const char *shape : {"hex", "tet", "wedge"})
    ExpectRanksDoNotMatter(QuietScene(shape, "-ts_max_steps 500 -device cpu"));
  ExpectRanksDoNotMatter(QuietScene("hex", "-damping_beta 2e-5 -ts_max_steps 500 -device cpu"));
}

TEST(Ranks, DoNotMatterInSinglePrecision) {
  for (const std::string &scene : SingleScenes())
    ExpectRanksDoNotMatter(scene + " -precision single -ts_max_steps 300 -device cpu");
}

TEST(Ranks, DoNotMatterWithOneCellEach) {
  ExpectRanksDoNotMatter(
      std::string("-mesh box -mesh_box_cells 3,1,1 -mesh_box_size 3,1,1 -gravity 0,0,-9.81 -ts_max_steps 100 "
                  "-boundaries xmin -boundary_xmin_fix xyz -interfaces j -interface_j_on all "
                  "-device cpu") +
      kRock);
}

}  // namespace
}  // namespace cdem
