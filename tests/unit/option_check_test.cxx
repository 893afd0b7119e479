// Options that nobody reads: misspelt, of names that are not declared, of no use; and stray words.
#include "unit/options_fixture.hpp"

#include <array>

namespace cdem {
namespace {

using OptionCheckTest = OptionsTest;

TEST_F(OptionCheckTest, UnknownOnesAreNamedWithTheNearest) {
  const std::array<std::array<const char *, 2>, 9> cases = {
      {{"-gravty 0", "did you mean -gravity?"},
       {"-block_yung 1", "did you mean -block_young?"},
       {"-block_rock_yung 1", "did you mean -block_rock_young?"},
       {"-ts_max_stesp 1", "did you mean -ts_max_steps?"},
       {"-log_veiw", "did you mean -log_view?"},
       {"-dm_refin 1", "did you mean -dm_refine?"},
       {"-boundries a", "did you mean -boundaries?"},
       {"-phases a", "nearest known: -"},
       {"-interface_f_stifness_factor 1", "-interface_f_stiffness_factor?"}}};
  options_.Declare("block", {"rock"});
  options_.Declare("interface", {"f"});
  for (const auto &[line, hint] : cases) {
    Give(line);
    const std::string name = std::string(line).substr(0, std::string(line).find(' '));
    ExpectLeftRefused({("unknown option " + name).c_str(), hint});
    ASSERT_EQ(PetscOptionsClearValue(nullptr, name.c_str()), PETSC_SUCCESS);
  }
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);
}

TEST_F(OptionCheckTest, UnknownFamiliesAreErrors) {
  for (const char *name : {"-stage_a_solve", "-flow", "-boundary_absorb", "-accuracy"}) {
    ASSERT_EQ(PetscOptionsSetValue(nullptr, name, "1"), PETSC_SUCCESS);
    ExpectLeftRefused({(std::string("unknown option ") + name).c_str()});
    ASSERT_EQ(PetscOptionsClearValue(nullptr, name), PETSC_SUCCESS);
  }
}

TEST_F(OptionCheckTest, UndeclaredNamesAreErrors) {
  options_.Declare("boundary", {"bottom", "sides"});
  options_.Declare("block", {"rock"});
  Give("-boundary_bottm_fix xyz -velocity_clay 0,0,1 -table_pulse_type sine");
  ExpectLeftRefused({"-boundary_bottm_fix: there is no boundary bottm; boundaries are: bottom, sides",
                     "did you mean -boundary_bottom_fix?", "-velocity_clay: there is no region clay; regions are: rock",
                     "-table_pulse_type: there is no table pulse; none are declared (-tables)"});
}

TEST_F(OptionCheckTest, NamesWithUnderscores) {
  options_.Declare("interface", {"fault", "old_fault"});
  Give("-interface_old_fault_keep_tension -interface_fault_tension 1 -interface_new_fault_keep_tension");
  bool flag = false;
  double value;
  EXPECT_EQ(options_.Flag({"interface", "old_fault", "keep_tension"}, &flag), PETSC_SUCCESS);
  EXPECT_EQ(options_.Real({"interface", "fault", "tension"}, &value), PETSC_SUCCESS);
  EXPECT_TRUE(flag);
  ExpectLeftRefused({"there is no interface new_fault; interfaces are: fault, old_fault"});
}

TEST_F(OptionCheckTest, AmbiguousNamesAreErrors) {
  options_.Declare("interface", {"a", "a_keep"});
  bool flag;
  EXPECT_EQ(options_.Flag({"interface", "a", "keep_tension"}, &flag), PETSC_SUCCESS);
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);  // not given: no harm
  Give("-interface_a_keep_tension");
  ExpectLeftRefused(
      {"-interface_a_keep_tension may mean", "tension of interface a_keep", "keep_tension of interface a"});
  options_.Declare("block", {"Rock", "rock"});
  ExpectLeftRefused({"regions 'Rock' and 'rock'"});
}

TEST_F(OptionCheckTest, UnusedOnesAreErrors) {
  options_.Declare("interface", {"fault"});
  Give("-interface_fault_tension 1 -table_frequency 3 -mesh_box_jitter 0.1");
  ExpectLeftRefused(
      {"no use for -interface_fault_tension", "no use for -table_frequency", "no use for -mesh_box_jitter"});
}

TEST_F(OptionCheckTest, ManyProblemsAreCut) {
  for (int i = 0; i < 50; ++i)
    ASSERT_EQ(
        PetscOptionsSetValue(nullptr, ("-block_" + std::string(60, 'x') + std::to_string(i) + "_young").c_str(), "1"),
        PETSC_SUCCESS);
  Give("-gravitty 1");
  ExpectLeftRefused({"unknown option -gravitty", "more"});
}

TEST_F(OptionCheckTest, PetscsLateOptionsPass) {
  Give(
      "-ts_view -dm_view ascii:x -log_view -options_left no -malloc_view -petscpartitioner_type simple -sf_type basic "
      "-use_gpu_aware_mpi 0 -ts_view_solution -options_view");
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);
}

TEST_F(OptionCheckTest, StrayWordsAreErrors) {
  const auto check = [](std::vector<std::string> words) {
    words.insert(words.begin(), "cdem");
    std::vector<char *> argv;
    for (std::string &word : words) argv.push_back(word.data());
    return CheckArguments(static_cast<int>(argv.size()), argv.data());
  };
  EXPECT_EQ(check({}), PETSC_SUCCESS);
  EXPECT_EQ(check({"-gravity", "-9.81", "-seed", "-5", "-deterministic", "--help", "-mesh", "box", "-x", "-inf"}),
            PETSC_SUCCESS);
  ExpectRefused([&] { return check({"foo.yaml"}); }, {"'foo.yaml'", "-options_file foo.yaml"});
  ExpectRefused([&] { return check({"run"}); }, {"'run'", "-options_file"});
  ExpectRefused([&] { return check({"-mesh", "box", "brick.yaml"}); }, {"-options_file brick.yaml"});
  ExpectRefused([&] { return check({"-gravity", "0", "0", "-9.81"}); }, {"'0' after '-gravity 0'", "commas"});
  ExpectRefused([&] { return check({"-gravity", "0,", "-9.81"}); }, {"'-9.81' after '-gravity 0,'"});
}

}  // namespace
}  // namespace cdem
