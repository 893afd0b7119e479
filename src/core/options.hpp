// The options of a scene: one registry (name, type, unit, default, text) from which reading, -help, the docs page and
// "did you mean" are made. Reading an option that is not in the registry is an error of the program.
#pragma once
#include "core/petsc.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

enum class OptionType { kFlag, kInt, kReal, kReals, kTensor, kInts, kWord, kText, kNames, kViewer };

/// One row of the registry. Names of a family carry a placeholder: "block_<region>_young" is -block_rock_young for
/// region rock and -block_young for every region. Lists (kReals, kInts) hold three values, for x, y, z;
/// tensors six, for xx, yy, zz, xy, yz, xz.
struct OptionSpec {
  const char *name;  ///< without the dash
  OptionType type;
  const char *unit;      ///< "" when there is none
  const char *fallback;  ///< default as text, "required", "required by <word>" or "" (absent)
  const char *text;      ///< what it does
  const char *choices;   ///< comma-separated words that kWord and kNames may take, or ""
};

/// A heading of -help and of the docs page; it begins at the row of that name.
struct OptionSection {
  const char *first, *title, *text;
};

const std::vector<OptionSpec> &OptionSpecs();
const std::vector<OptionSection> &OptionSections();

/// Adds a row behind those of its family. Where the row is there already, only its choices grow by those of spec. For
/// what is listed elsewhere (laws and their properties): call it before anything is read. Texts are copied.
void AddOption(const OptionSpec &spec);

/// Names one option: plain {"gravity"} or of a family {"block", "rock", "young"}; {"velocity", "rock", ""} is
/// -velocity_rock. An empty name means everybody's.
struct OptionKey {
  std::string family, name, key;
  OptionKey(const char *plain) : family(plain) {}
  OptionKey(std::string f, std::string n, std::string k)
      : family(std::move(f)), name(std::move(n)), key(std::move(k)) {}
};

/// Reads options from PETSc's database. Each getter leaves the value alone and returns set = false when the option is
/// not given (for a family: neither with the name nor for everybody); a given option without a value, with the wrong
/// number of values, not finite, or not a listed word is an error that says so. With set = nullptr an option whose
/// default is "required" must be given. Collective.
class Options {
 public:
  explicit Options(MPI_Comm comm) : comm_(comm) {}
  MPI_Comm comm() const { return comm_; }

  PetscErrorCode Has(const OptionKey &key, bool *set);
  /// Which of the stages gives what a getter finds, from 0; -1: the run as a whole; -2: nobody.
  PetscErrorCode GivenBy(const OptionKey &key, int *stage);
  PetscErrorCode Flag(const OptionKey &key, bool *value, bool *set = nullptr);
  PetscErrorCode Int(const OptionKey &key, PetscInt *value, bool *set = nullptr);
  PetscErrorCode Real(const OptionKey &key, double *value, bool *set = nullptr);
  PetscErrorCode Reals(const OptionKey &key, int n, double *values, bool *set = nullptr);
  PetscErrorCode Ints(const OptionKey &key, int n, PetscInt *values, bool *set = nullptr);
  PetscErrorCode Word(const OptionKey &key, std::string *value, bool *set = nullptr);
  /// Of kText and kViewer; the value of a viewer may be empty.
  PetscErrorCode Text(const OptionKey &key, std::string *value, bool *set = nullptr);
  /// Different names, each made of letters, digits, '_', '-' and '.'.
  PetscErrorCode Names(const OptionKey &key, std::vector<std::string> *value, bool *set = nullptr);

  /// From now on -stage_<name>_<option> stands before -<option>, the last of these stages first. Names add up over stages.
  void SetStages(const std::vector<std::string> &names) { stages_ = names; }

  /// Tells which names a family has (regions for block, declared names for boundary, ...): an option that names another
  /// one is an error that lists them. Families of regions share their names.
  void Declare(const std::string &family, const std::vector<std::string> &names);

  /// The option as a user would type it, for messages: "-block_rock_young (or -block_young)".
  static std::string Spelled(const OptionKey &key);

  /// Error for every option given that nobody read: unknown ones with the nearest known name, undeclared names with the
  /// list of declared ones, known ones that this scene has no use for. Options that PETSc reads later (-ts_view,
  /// -log_view, ...) pass. Call when everything has been read, TSSetFromOptions included, before anything is computed.
  PetscErrorCode CheckLeft();

 private:
  struct Given;
  PetscErrorCode Find(const std::string &name, bool *set, const char **value, std::string *spelled);
  PetscErrorCode Raw(const OptionKey &key, std::vector<OptionType> types, bool asked, Given *given);
  PetscErrorCode CheckEverybodys(const OptionKey &key, const OptionSpec &spec);
  PetscErrorCode Count(const Given &given, int n, std::vector<std::string> *words);
  PetscErrorCode Choice(const Given &given, const std::string &word);
  PetscErrorCode CheckNames();
  std::vector<std::string> Known() const;
  std::string Complaint(const std::string &left, int *rank) const;

  MPI_Comm comm_;
  std::map<std::string, std::vector<std::string>> declared_;  // names by noun (region, boundary, ...)
  std::vector<std::string> stages_;                           // whose overrides are in force, in order
};

/// Whether the whole word is a finite number, which it then gives.
bool ParseReal(const std::string &word, double *value);

/// Error for words on the command line that belong to no option (PETSc would ignore them).
PetscErrorCode CheckArguments(int argc, char **argv);

/// Error for a YAML file of options with more than one document (PETSc would ignore all but the first), and for a quote
/// without an end in a file of another kind.
PetscErrorCode CheckOptionFiles(int argc, char **argv);

/// Prints the registry as -help does (all families, units, defaults), or as the Markdown page docs/options.md.
PetscErrorCode PrintOptions(MPI_Comm comm, bool markdown);

}  // namespace cdem
