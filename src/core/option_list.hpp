// The options of a run as a list: to write them down, and to compare two runs.
#pragma once
#include "core/petsc.hpp"

#include <string>
#include <vector>

namespace cdem {

/// An option as the database has it, without the dash.
struct GivenOption {
  std::string name, value;
  bool has_value = false;
};

/// Every option of the database but those that read others (-options_file), sorted as PETSc keeps them. What nobody has
/// read counts as unread afterwards too.
PetscErrorCode ListOptions(std::vector<GivenOption> *options);

/// One line of a PETSc options file; a value that no such file can hold becomes a comment.
std::string OptionLine(const GivenOption &option);

/// Those that say what the scene is (mesh, laws, interfaces, joints, boundaries, loads, damping, seed), and not how long,
/// where and by whom watched it runs. Names of files are left out: their content counts, not where it lies.
/// Tabs and ends of lines in values become blanks.
std::vector<GivenOption> SceneOptions(const std::vector<GivenOption> &options);

/// What differs between the options of two scenes, a sentence: "-gravity was 0,0,-9.81 and is 0,0,-10 now; ...", or "".
/// Numbers are compared as numbers, and an option that is not given counts as its default where it has one.
/// [in] stage: the last one (from 0) that counts: later ones may be other ones.
std::string SceneDifference(const std::vector<GivenOption> &was, const std::vector<GivenOption> &now, int stage = 0);

}  // namespace cdem
