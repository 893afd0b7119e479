// What restarts are made of: options of two scenes compared, names of files, the state of the time stepper, rows in global
// order. Whole runs are in tests/regression/test_restart.py.
#include "../support/run_scene.hpp"
#include "core/checksum.hpp"
#include "core/option_list.hpp"
#include "io/result_names.hpp"

#include <algorithm>
#include <set>

namespace cdem {
namespace {

using Given = std::vector<GivenOption>;

TEST(Restart, ScenesAreComparedByValue) {
  RegisterOnce();
  const Given was = {
      {"block_young", "1e9", true}, {"gravity", "0,0,-9.81", true}, {"block_release_interfaces", "", false}};
  EXPECT_EQ(SceneDifference(was, was), "");
  EXPECT_EQ(SceneDifference(was, {{"BLOCK_young", "1000000000", true},
                                  {"gravity", "0.0, 0,-981e-2", true},
                                  {"block_release_interfaces", "true", true},
                                  {"seed", "1", true},
                                  {"damping_alpha", "0.0", true}}),
            "");
  EXPECT_EQ(SceneDifference(was, {{"block_young", "2e9", true}, was[1], was[2]}),
            "-block_young was 1e9 and is 2e9 now");
  EXPECT_EQ(SceneDifference(was, {was[0], was[1]}), "-block_release_interfaces was given and is not given now");
  EXPECT_EQ(SceneDifference(was, {was[0], was[1], was[2], {"seed", "2", true}}), "-seed was not given and is 2 now");
  // the default counts for a name of its own only where everybody's says nothing
  const Given named = {{"interface_a_initial", "intact", true}};
  EXPECT_EQ(SceneDifference({}, named), "");
  const Given all = {{"interface_initial", "broken", true}};
  EXPECT_NE(SceneDifference(all, {all[0], named[0]}), "");
}

TEST(Restart, OptionsOfTheScene) {
  RegisterOnce();
  std::set<std::string> kept;
  for (const char *name : {"block_rock_young",
                           "block_young",
                           "velocity",
                           "velocity_rock",
                           "seed",
                           "mesh_box_cells",
                           "solve",
                           "table_a_type",
                           "damping_beta",
                           "joint_j_p32",
                           "interface_f_law",
                           "boundary_b_fix",
                           "mesh",
                           "table_a_file",
                           "ts_max_steps",
                           "ts_dt",
                           "histories",
                           "history_a_at",
                           "history_interval",
                           "monitor_energy",
                           "output",
                           "output_fields",
                           "checkpoint_interval",
                           "restart",
                           "device",
                           "ts_monitor",
                           "log_view",
                           "dm_refine",
                           "deterministic",
                           "central_way",
                           "central_mat_type"})
    for (const GivenOption &option : SceneOptions({{name, "x\ty", true}})) {
      kept.insert(option.name);
      EXPECT_EQ(option.value, "x y");
    }
  EXPECT_EQ(kept, (std::set<std::string>{"block_rock_young", "block_young", "velocity", "velocity_rock", "seed",
                                         "mesh_box_cells", "solve", "table_a_type", "damping_beta", "joint_j_p32",
                                         "interface_f_law", "boundary_b_fix"}));
}

TEST(Restart, NamesOfResults) {
  std::string head;
  EXPECT_EQ(NumberIn("checkpoint_120.h5", ".h5", &head), 120);
  EXPECT_EQ(head, "checkpoint");
  EXPECT_EQ(NumberIn("fields_mesh_000.h5", ".h5", &head), 0);
  EXPECT_EQ(head, "fields_mesh");
  for (const char *name : {"checkpoint_.h5", "checkpoint_1x.h5", "120.h5", "checkpoint_120.h5.part"})
    EXPECT_EQ(NumberIn(name, ".h5", &head), -1) << name;
  for (const char *name : {"checkpoint_120.h5", "fields_000001.hdf", "fields_mesh_000.h5", "histories.csv"})
    EXPECT_TRUE(IsResult(name)) << name;
  for (const char *name : {"terrain.hdf", "rock_mesh_fine.h5", "my_120.h5", "notes.txt", "scene.opts"})
    EXPECT_FALSE(IsResult(name)) << name;
  EXPECT_TRUE(IsLeftover("checkpoint_120.h5.part"));
  EXPECT_FALSE(IsLeftover("notes.part"));
}

TEST(Restart, ChecksumsDoNotKnowThePieces) {
  std::vector<double> rows(30);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = 0.1 * static_cast<double>(i * i);
  const std::uint64_t whole = SumOfRows(7, 0, 10, 24, rows.data());
  EXPECT_EQ(SumOfRows(7, 0, 4, 24, rows.data()) + SumOfRows(7, 4, 6, 24, &rows[12]), whole);
  std::swap_ranges(rows.begin(), rows.begin() + 3, rows.begin() + 3);
  EXPECT_NE(SumOfRows(7, 0, 10, 24, rows.data()), whole) << "two rows changed places";
  EXPECT_NE(SumOfRows(8, 0, 10, 24, rows.data()), SumOfRows(7, 0, 10, 24, rows.data())) << "another array";
  const char bytes[] = "abcdefghijk";
  EXPECT_NE(SumOfRows(7, 0, 1, 11, bytes), SumOfRows(7, 0, 1, 10, bytes));
}

TEST(Restart, FingerprintsSayWhatDiffers) {
  const Fingerprint was = {{"elements", 60}, {"sum: masses", 5}, {"sum: time tables", 1}};
  EXPECT_EQ(FingerprintDifference(was, was), "");
  EXPECT_EQ(FingerprintDifference(was, {{"elements", 75}, {"sum: masses", 6}, {"sum: time tables", 1}}),
            "60 elements, and 75 now; other masses");
  EXPECT_EQ(FingerprintDifference({}, {{"elements", 75}}), "no elements, and 75 now");
}

}  // namespace
}  // namespace cdem
