// How the names of options are made, taken apart and compared; for src/core/option*.cxx only.
#pragma once
#include "core/options.hpp"

namespace cdem {

/// The name of a row taken apart: "boundary_<name>_fix" is {"boundary", "boundary", "fix"}, "block_<region>_young" is
/// {"block", "region", "young"}. A plain option has its name as family and no noun.
struct OptionPattern {
  std::string family, noun, key;

  explicit OptionPattern(const OptionSpec &spec);
  bool Plain() const { return noun.empty(); }
  /// Without the dash; an empty name is everybody's.
  std::string Spell(const std::string &name) const;
};

/// The row of that option, nullptr if there is none.
const OptionSpec *FindOption(const OptionKey &key);

/// The row of a family that fits a given option (of several the one with the longest key), and the name in it; nullptr if
/// none does. Large and small letters are the same.
const OptionSpec *FindFamily(const std::string &option, std::string *name);

/// What a value looks like: "a number [Pa]", "one of elastic, brittle".
std::string Expected(const OptionSpec &spec);

/// "region" gives "regions", "boundary" "boundaries".
std::string Plural(const std::string &noun);

std::string Lower(std::string text);
/// Cut at commas, without the spaces round each.
std::vector<std::string> SplitList(const std::string &text);
/// "a, b, c", or "a, b, ... (70)" when there are many.
std::string ListNames(const std::vector<std::string> &names);

/// Whether PETSc has this option, under exactly this name (without the dash); it then counts as read. PETSc's own search
/// takes -block_young for -block_1_young too.
PetscErrorCode FindGiven(const std::string &name, bool *set, const char **value);

/// The candidate that takes the fewest changes (a letter added, dropped, replaced, two swapped).
std::string Nearest(const std::string &name, const std::vector<std::string> &candidates, int *changes);
/// Whether that few changes may be a slip of the hand.
bool LooksLike(const std::string &name, int changes);

/// An option of PETSc that the page lists.
struct PetscOptionRow {
  const char *name, *type, *fallback, *text;
};
const std::vector<PetscOptionRow> &PetscOptionRows();
/// Names that PETSc reads after set-up, or only in some builds and on some numbers of ranks.
const std::vector<std::string> &LatePetscOptions();

}  // namespace cdem
