// What was given but not read, and words that belong to no option: PETSc passes over both in silence.
#include "core/error.hpp"
#include "core/option_names.hpp"

#include <algorithm>

namespace cdem {

/// Every name that could be given in this scene: plain ones, everybody's, those of the declared names; then PETSc's.
std::vector<std::string> Options::Known() const {
  std::vector<std::string> known;
  for (const OptionSpec &spec : OptionSpecs()) {
    const OptionPattern pattern(spec);
    if (pattern.Plain() || !pattern.key.empty()) known.push_back(pattern.Spell(""));
    const auto names = declared_.find(pattern.noun);
    if (pattern.Plain() || names == declared_.end()) continue;
    for (const std::string &name : names->second) known.push_back(pattern.Spell(name));
  }
  for (const PetscOptionRow &row : PetscOptionRows()) known.push_back(row.name);
  for (const std::string &name : LatePetscOptions()) known.push_back(name);
  return known;
}

static bool IsOneOf(const std::vector<std::string> &names, const std::string &name) {
  return std::any_of(names.begin(), names.end(), [&](const std::string &other) { return Lower(other) == Lower(name); });
}

static bool IsPetscs(const std::string &option) {
  for (const char *head : {"dm_", "ts_", "vec_", "mat_", "sf_", "ksp_", "snes_", "petscpartitioner_", "log_"})
    if (Lower(option).rfind(head, 0) == 0) return true;
  return false;
}

/// What is wrong with an option that nobody read, "" if nothing. [out] rank: unknown ones (0) are said first.
std::string Options::Complaint(const std::string &left, int *rank) const {
  const std::vector<std::string> known = Known();
  const std::string given = "-" + left;
  if (IsOneOf(LatePetscOptions(), left)) return "";
  const auto stages = declared_.find("stage");
  if (stages != declared_.end())
    for (const std::string &stage : stages->second) {
      const std::string head = "stage_" + Lower(stage) + "_";
      if (Lower(left).rfind(head, 0) != 0) continue;
      const std::string inner = left.substr(head.size());
      *rank = 2;
      if (IsOneOf(known, inner) || IsOneOf(LatePetscOptions(), inner))
        return given + ": a stage cannot change -" + inner + ", or has no use for it; take it out";
      const std::string complaint = Complaint(inner, rank);
      return "in stage " + stage + ": " + complaint;
    }
  if (IsOneOf(known, left)) {
    *rank = 2;
    return "this scene has no use for " + given +
           ": it belongs to another law, type or way of running, or nothing refers "
           "to it; take it out";
  }
  int changes = 0;
  const std::string nearest = Nearest(left, known, &changes);
  const bool slip = LooksLike(left, changes);
  std::string name;
  if (const OptionSpec *family = FindFamily(left, &name)) {
    *rank = 1;
    const std::string noun = OptionPattern(*family).noun;
    const auto names = declared_.find(noun);
    std::string text = given + ": there is no " + noun + " " + name + "; ";
    if (names == declared_.end() || names->second.empty())
      text += noun == "region" ? "no regions are known" : "none are declared (-" + Plural(noun) + ")";
    else
      text += Plural(noun) + " are: " + ListNames(names->second) +
              (noun == "region" ? "" : " (declared with -" + Plural(noun) + ")");
    return text + (slip ? "; did you mean -" + nearest + "?" : "");
  }
  *rank = 0;
  if (slip) return "unknown option " + given + "; did you mean -" + nearest + "?";
  return "unknown option " + given + (IsPetscs(left) ? ": PETSc does not read it here either" : "") +
         " (nearest known: -" + nearest + "); -help lists them all";
}

/// Names that options cannot tell apart, and given options that may be meant in two ways.
PetscErrorCode Options::CheckNames() {
  PetscFunctionBeginUser;
  for (const auto &[noun, names] : declared_)
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t j = i + 1; j < names.size(); ++j)
        CdemCheck(Lower(names[i]) != Lower(names[j]), comm_,
                  "the %s '%s' and '%s' cannot be told apart in options, which do not know large from small letters: "
                  "rename one",
                  Plural(noun).c_str(), names[i].c_str(), names[j].c_str());
  std::map<std::string, std::string> meaning;
  for (const OptionSpec &spec : OptionSpecs()) {
    const OptionPattern pattern(spec);
    std::vector<std::string> names = {""};
    const auto declared = declared_.find(pattern.noun);
    if (declared != declared_.end()) names.insert(names.end(), declared->second.begin(), declared->second.end());
    for (const std::string &name : names) {
      if (!pattern.Plain() && pattern.key.empty() && name.empty()) continue;  // the plain one has a row of its own
      const std::string mine =
          pattern.Plain() ? "-" + pattern.family
          : name.empty()  ? pattern.key + " of all " + Plural(pattern.noun)
                          : (pattern.key.empty() ? pattern.family : pattern.key) + " of " + pattern.noun + " " + name;
      const auto [other, first] = meaning.emplace(Lower(pattern.Spell(name)), mine);
      if (first) continue;
      bool set;
      const char *value;
      PetscCall(FindGiven(pattern.Spell(name), &set, &value));
      CdemCheck(!set, comm_, "-%s may mean: %s, or: %s; rename one", pattern.Spell(name).c_str(), other->second.c_str(),
                mine.c_str());
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::CheckLeft() {
  constexpr std::size_t kMost = 10;  // lines; an error's text is cut at 2048 signs
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  std::vector<std::string> of_rank[3];
  PetscFunctionBeginUser;
  PetscCall(CheckNames());
  PetscCall(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  for (PetscInt i = 0; i < n; ++i) {
    int rank = 0;
    const std::string complaint = Complaint(names[i], &rank);
    if (!complaint.empty()) of_rank[rank].push_back(complaint);
  }
  PetscCall(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  std::vector<std::string> lines;
  for (const auto &list : of_rank) lines.insert(lines.end(), list.begin(), list.end());
  std::string text;
  std::size_t shown = 0;
  while (shown < std::min(lines.size(), kMost) && text.size() + lines[shown].size() < 1900)
    text += (shown ? "\n             " : "") + lines[shown], ++shown;
  if (shown < lines.size()) text += "\n             and " + std::to_string(lines.size() - shown) + " more";
  CdemCheck(lines.empty(), comm_, "%s", text.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool LooksLikeFile(const std::string &word) {
  for (const std::string ending : {".yaml", ".yml", ".opts", ".txt"})
    if (word.size() > ending.size() && word.compare(word.size() - ending.size(), ending.size(), ending) == 0)
      return true;
  return false;
}

PetscErrorCode CheckArguments(int argc, char **argv) {
  PetscBool is_option = PETSC_FALSE;
  std::string before;  // the option and value that a stray word follows
  PetscFunctionBeginUser;
  for (int i = 1; i < argc;) {
    const std::string word = argv[i];
    PetscCall(PetscOptionsValidKey(argv[i], &is_option));
    CdemCheck(is_option || !LooksLikeFile(word), PETSC_COMM_WORLD,
              "'%s' belongs to no option; a scene is given with -options_file %s", word.c_str(), word.c_str());
    CdemCheck(is_option || !before.empty(), PETSC_COMM_WORLD,
              "'%s' belongs to no option; options begin with '-', a scene is given with -options_file FILE",
              word.c_str());
    CdemCheck(
        is_option, PETSC_COMM_WORLD,
        "'%s' after '%s' belongs to no option; a value is one word, and a list is joined by commas without spaces",
        word.c_str(), before.c_str());
    before = word;
    ++i;
    if (i == argc || Lower(word) == "-prefix_pop") continue;
    PetscCall(PetscOptionsValidKey(argv[i], &is_option));
    if (!is_option) before += std::string(" ") + argv[i++];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
