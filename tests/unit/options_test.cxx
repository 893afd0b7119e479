// Options as a user gives them: values of every type, and which values are refused.
#include "unit/options_fixture.hpp"

#include <set>

namespace cdem {
namespace {

TEST_F(OptionsTest, AbsentOnesLeaveTheValueAlone) {
  double real = 3, reals[3] = {1, 2, 3};
  PetscInt whole = 4;
  bool flag = true, set = true;
  std::string word = "reference";
  std::vector<std::string> names = {"a"};
  EXPECT_EQ(options_.Real("damping_alpha", &real, &set), PETSC_SUCCESS);
  EXPECT_FALSE(set);
  EXPECT_EQ(options_.Reals("gravity", 3, reals), PETSC_SUCCESS);
  EXPECT_EQ(options_.Int("seed", &whole), PETSC_SUCCESS);
  EXPECT_EQ(options_.Flag("deterministic", &flag), PETSC_SUCCESS);
  EXPECT_EQ(options_.Word("central_way", &word), PETSC_SUCCESS);
  EXPECT_EQ(options_.Names("interfaces", &names), PETSC_SUCCESS);
  EXPECT_EQ(real, 3);
  EXPECT_EQ(reals[2], 3);
  EXPECT_EQ(whole, 4);
  EXPECT_TRUE(flag);
  EXPECT_EQ(word, "reference");
  EXPECT_EQ(names.size(), 1u);
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);
}

TEST_F(OptionsTest, ReadsEveryType) {
  Give(
      "-damping_alpha 1.5e-3 -gravity 0,0,-9.81 -mesh_box_cells 10,1e1,3 -seed 1e6 -deterministic -output_overwrite no "
      "-solve dynamic -output results -interfaces fault,bed.2 -monitor_energy -monitor_progress ascii:log.txt");
  double real = 0, reals[3];
  PetscInt whole = 0, wholes[3];
  bool flag = false, other = true, set = false;
  std::string word, text, viewer = "x";
  std::vector<std::string> names;
  EXPECT_EQ(options_.Real("damping_alpha", &real, &set), PETSC_SUCCESS);
  EXPECT_TRUE(set);
  EXPECT_EQ(options_.Reals("gravity", 3, reals), PETSC_SUCCESS);
  EXPECT_EQ(options_.Ints("mesh_box_cells", 3, wholes), PETSC_SUCCESS);
  EXPECT_EQ(options_.Int("seed", &whole), PETSC_SUCCESS);
  EXPECT_EQ(options_.Flag("deterministic", &flag), PETSC_SUCCESS);
  EXPECT_EQ(options_.Flag("output_overwrite", &other), PETSC_SUCCESS);
  EXPECT_EQ(options_.Word("solve", &word), PETSC_SUCCESS);
  EXPECT_EQ(options_.Text("output", &text), PETSC_SUCCESS);
  EXPECT_EQ(options_.Names("interfaces", &names), PETSC_SUCCESS);
  EXPECT_EQ(options_.Text("monitor_energy", &viewer), PETSC_SUCCESS);
  EXPECT_TRUE(IsSet("monitor_progress"));
  EXPECT_EQ(real, 1.5e-3);
  EXPECT_EQ(reals[2], -9.81);
  EXPECT_EQ(wholes[1], 10);
  EXPECT_EQ(whole, 1000000);
  EXPECT_TRUE(flag);
  EXPECT_FALSE(other);
  EXPECT_EQ(word, "dynamic");
  EXPECT_EQ(text, "results");
  EXPECT_EQ(names, (std::vector<std::string>{"fault", "bed.2"}));
  EXPECT_EQ(viewer, "");
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);
}

TEST_F(OptionsTest, ReadsYaml) {
  GiveYaml(
      "mesh: box\nmesh_box: {cells: [10, 10, 10], size: [1, 2.5, 1.0e1]}\n"
      "block:\n  rock: {law: elastic, young: 1.0e10}\ngravity: [0, 0, -9.81]\ndeterministic: true\n"
      "boundaries: [zmin, zmax]\noutput: \"a folder\"\nmonitor_energy:\n");
  PetscInt cells[3];
  double size[3], young = 0;
  bool flag = false;
  std::string text;
  std::vector<std::string> names;
  EXPECT_EQ(options_.Ints("mesh_box_cells", 3, cells), PETSC_SUCCESS);
  EXPECT_EQ(options_.Reals("mesh_box_size", 3, size), PETSC_SUCCESS);
  EXPECT_EQ(options_.Real({"block", "rock", "young"}, &young), PETSC_SUCCESS);
  EXPECT_EQ(options_.Flag("deterministic", &flag), PETSC_SUCCESS);
  EXPECT_EQ(options_.Names("boundaries", &names), PETSC_SUCCESS);
  EXPECT_EQ(options_.Text("output", &text), PETSC_SUCCESS);
  EXPECT_EQ(cells[2], 10);
  EXPECT_EQ(size[1], 2.5);
  EXPECT_EQ(young, 1e10);
  EXPECT_TRUE(flag);
  EXPECT_EQ(names, (std::vector<std::string>{"zmin", "zmax"}));
  EXPECT_EQ(text, "a folder");
  EXPECT_TRUE(IsSet("monitor_energy"));
}

TEST_F(OptionsTest, NamedComesBeforeEverybodys) {
  Give("-block_young 1 -block_rock_young 2 -Block_Clay_Young 3 -velocity 1,0,0 -velocity_rock 0,0,5");
  double value = 0, v[3];
  options_.Declare("block", {"rock", "clay", "sand"});
  EXPECT_EQ(options_.Real({"block", "rock", "young"}, &value), PETSC_SUCCESS);
  EXPECT_EQ(value, 2);
  EXPECT_EQ(options_.Real({"block", "clay", "young"}, &value), PETSC_SUCCESS);
  EXPECT_EQ(value, 3);
  EXPECT_EQ(options_.Real({"block", "sand", "young"}, &value), PETSC_SUCCESS);
  EXPECT_EQ(value, 1);
  EXPECT_EQ(options_.Reals({"velocity", "rock", ""}, 3, v), PETSC_SUCCESS);
  EXPECT_EQ(v[2], 5);
  EXPECT_EQ(options_.Reals({"velocity", "sand", ""}, 3, v), PETSC_SUCCESS);
  EXPECT_EQ(v[0], 1);
  EXPECT_EQ(options_.CheckLeft(), PETSC_SUCCESS);  // everybody's counts as read although all may have their own
  EXPECT_EQ(Options::Spelled({"block", "rock", "young"}), "-block_rock_young (or -block_young)");
  EXPECT_EQ(Options::Spelled({"velocity", "rock", ""}), "-velocity_rock (or -velocity)");
  EXPECT_EQ(Options::Spelled("gravity"), "-gravity");
}

TEST_F(OptionsTest, NumbersInNamesAreNotDropped) {
  Give("-block_bed_young 7 -block_young 1");
  double value = 0;
  EXPECT_EQ(options_.Real({"block", "bed_2", "young"}, &value), PETSC_SUCCESS);  // PETSc itself would find 7
  EXPECT_EQ(value, 1);
  Give("-block_bed_2_young 9");
  EXPECT_EQ(options_.Real({"block", "bed_2", "young"}, &value), PETSC_SUCCESS);
  EXPECT_EQ(value, 9);
}

TEST_F(OptionsTest, RefusesBadNumbers) {
  for (const char *bad : {"10abc", "nan", "inf", "1e999", "-", "1,2", "stiff"}) {
    ASSERT_EQ(PetscOptionsSetValue(nullptr, "-damping_alpha", bad), PETSC_SUCCESS);
    double value = 5;
    ExpectRefused([&] { return options_.Real("damping_alpha", &value); }, {"-damping_alpha", bad, "a number [1/s]"});
    EXPECT_EQ(value, 5);
  }
  for (const char *bad : {"1.5", "x", "1e30", "nan", "99999999999999999999"}) {
    ASSERT_EQ(PetscOptionsSetValue(nullptr, "-seed", bad), PETSC_SUCCESS);
    PetscInt value;
    ExpectRefused([&] { return options_.Int("seed", &value); }, {"-seed", bad, "an integer"});
  }
  double v[3];
  Give("-gravity 0,-9.81");
  ExpectRefused([&] { return options_.Reals("gravity", 3, v); },
                {"-gravity 0,-9.81 has 2 values", "3 numbers [m/s^2]"});
  Give("-gravity 0,0,-9.81,0");
  ExpectRefused([&] { return options_.Reals("gravity", 3, v); }, {"has 4 values"});
  Give("-gravity 0,0,-9.81m");
  ExpectRefused([&] { return options_.Reals("gravity", 3, v); }, {"'-9.81m'"});
  Give("-gravity 0,,1");
  ExpectRefused([&] { return options_.Reals("gravity", 3, v); }, {"''"});
}

TEST_F(OptionsTest, RefusesMissingValues) {
  Give("-gravity -seed -output -deterministic");
  double v[3];
  PetscInt i;
  std::string text;
  bool set;
  ExpectRefused([&] { return options_.Reals("gravity", 3, v); }, {"-gravity has no value", "3 numbers"});
  ExpectRefused([&] { return options_.Int("seed", &i); }, {"-seed has no value"});
  ExpectRefused([&] { return options_.Text("output", &text); }, {"-output has no value"});
  ExpectRefused([&] { return options_.Has("output", &set); }, {"-output has no value"});
  ExpectRefused([&] { return options_.Text("mesh", &text); }, {"-mesh is needed"});
  ExpectRefused(
      [&] {
        return options_.Real({"block", "rock", "young"}, v);
      },
      {"-block_rock_young (or -block_young) is needed", "[Pa]"});
}

TEST_F(OptionsTest, RefusesWordsNotListed) {
  Give(
      "-solve statics -interface_law britle -ts_central_check perhaps -deterministic maybe -output_fields "
      "stress,colour");
  std::string word;
  bool flag;
  std::vector<std::string> names;
  ExpectRefused([&] { return options_.Word("solve", &word); }, {"-solve", "'statics'", "dynamic, relax"});
  ExpectRefused(
      [&] {
        return options_.Word({"interface", "f", "law"}, &word);
      },
      {"-interface_law", "'britle'", "did you mean brittle?", "elastic, brittle"});
  ExpectRefused([&] { return options_.Word("ts_central_check", &word); }, {"'perhaps'", "error, warn, off"});
  ExpectRefused([&] { return options_.Flag("deterministic", &flag); }, {"'maybe'"});
  ExpectRefused([&] { return options_.Names("output_fields", &names); }, {"'colour'", "displacement"});
}

TEST_F(OptionsTest, RefusesBadNames) {
  std::vector<std::string> names;
  for (const char *bad : {"a,,b", "a,b,", "a b", "a:b", "a,A"}) {
    ASSERT_EQ(PetscOptionsSetValue(nullptr, "-interfaces", bad), PETSC_SUCCESS);
    ExpectRefused([&] { return options_.Names("interfaces", &names); }, {"-interfaces"});
  }
}

TEST_F(OptionsTest, ReadingWhatIsNotRegisteredIsAnErrorOfTheProgram) {
  double value;
  for (const OptionKey &key : {OptionKey("mesh"), OptionKey("phases"), OptionKey("block", "rock", "youngs")}) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(options_.Real(key, &value), PETSC_ERR_PLIB);
    testing::internal::GetCapturedStderr();
  }
}

TEST_F(OptionsTest, AddedRowsBelongToTheirFamily) {
  AddOption({"block_<region>_law", OptionType::kWord, "", "", "", "elastic,test_law"});
  AddOption({"block_<region>_test_strength", OptionType::kReal, "Pa", "required by test_law", "a strength", ""});
  Give("-block_law test_law -block_rock_test_strength 4");
  std::string law;
  double value = 0;
  EXPECT_EQ(options_.Word({"block", "rock", "law"}, &law), PETSC_SUCCESS);
  EXPECT_EQ(options_.Real({"block", "rock", "test_strength"}, &value), PETSC_SUCCESS);
  EXPECT_EQ(law, "test_law");
  EXPECT_EQ(value, 4);
}

TEST_F(OptionsTest, RegistryIsSound) {
  std::set<std::string> names;
  for (const OptionSpec &spec : OptionSpecs()) {
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name << " is there twice";
    EXPECT_NE(std::string(spec.text), "") << spec.name;
    EXPECT_EQ(std::string(spec.text).find('|'), std::string::npos) << spec.name;
    if (spec.type == OptionType::kWord) {
      EXPECT_NE(std::string(spec.choices), "") << spec.name;
    }
  }
  for (const OptionSection &section : OptionSections()) EXPECT_EQ(names.count(section.first), 1u) << section.title;
}

}  // namespace
}  // namespace cdem
