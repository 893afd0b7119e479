#include "core/options.hpp"

#include "core/error.hpp"
#include "core/option_names.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace cdem {

/// An option as the database has it.
struct Options::Given {
  const OptionSpec *spec = nullptr;
  std::string spelled;  ///< with the dash, as it was given
  std::string text;     ///< "" without a value
  bool set = false;
};

std::string Options::Spelled(const OptionKey &key) {
  const std::string everybody = "-" + key.family + (key.key.empty() ? "" : "_" + key.key);
  if (key.name.empty()) return everybody;
  return "-" + key.family + "_" + key.name + (key.key.empty() ? "" : "_" + key.key) + " (or " + everybody + ")";
}

void Options::Declare(const std::string &family, const std::vector<std::string> &names) {
  for (const OptionSpec &spec : OptionSpecs()) {
    const OptionPattern pattern(spec);
    if (pattern.Plain() || pattern.family != family) continue;
    std::vector<std::string> &all = declared_[pattern.noun];
    for (const std::string &name : names)
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    return;
  }
}

/// Finds an option by its whole name, or as the last stage that overrides it has it; all of them then count as read.
PetscErrorCode Options::Find(const std::string &name, bool *set, const char **value, std::string *spelled) {
  PetscFunctionBeginUser;
  PetscCall(FindGiven(name, set, value));
  *spelled = "-" + name;
  for (const std::string &stage : stages_) {
    const std::string in_stage = "stage_" + stage + "_" + name;
    const char *other;
    bool given;
    PetscCall(FindGiven(in_stage, &given, &other));
    if (!given) continue;
    *set = true, *value = other, *spelled = "-" + in_stage;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Finds the option by its name, else everybody's; both then count as read.
PetscErrorCode Options::Raw(const OptionKey &key, std::vector<OptionType> types, bool asked, Given *given) {
  PetscFunctionBeginUser;
  const OptionSpec *spec = FindOption(key);
  PetscCheck(spec, comm_, PETSC_ERR_PLIB, "option %s is not in the registry", Spelled(key).c_str());
  PetscCheck(types.empty() || std::find(types.begin(), types.end(), spec->type) != types.end(), comm_, PETSC_ERR_PLIB,
             "option %s is of another type in the registry", Spelled(key).c_str());
  given->spec = spec;
  const OptionPattern pattern(*spec);
  const char *value = nullptr, *everybodys_value = nullptr;
  bool named = false, everybodys = false;
  std::string everybodys_name;
  if (!key.name.empty()) PetscCall(Find(pattern.Spell(key.name), &named, &value, &given->spelled));
  PetscCall(Find(pattern.Spell(""), &everybodys, &everybodys_value, &everybodys_name));
  if (!named) value = everybodys_value, given->spelled = everybodys_name;
  given->set = named || everybodys;
  given->text = given->set && value ? value : "";
  const bool may_be_empty = spec->type == OptionType::kFlag || spec->type == OptionType::kViewer;
  CdemCheck(!given->set || may_be_empty || !given->text.empty(), comm_, "%s has no value; give %s",
            given->spelled.c_str(), Expected(*spec).c_str());
  CdemCheck(given->set || asked || std::string(spec->fallback) != "required", comm_, "%s is needed: %s, %s",
            Spelled(key).c_str(), Expected(*spec).c_str(), spec->text);
  if (named && everybodys) PetscCall(CheckEverybodys(key, *spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// What is given for everybody must make sense, also where this one has a value of its own.
PetscErrorCode Options::CheckEverybodys(const OptionKey &key, const OptionSpec &spec) {
  PetscFunctionBeginUser;
  const OptionKey all(key.family, "", key.key);
  std::string word;
  std::vector<std::string> names;
  double reals[6];
  PetscInt ints[3];
  bool flag, set;
  switch (spec.type) {
    case OptionType::kFlag:
      PetscCall(Flag(all, &flag, &set));
      break;
    case OptionType::kInt:
      PetscCall(Int(all, ints, &set));
      break;
    case OptionType::kReal:
      PetscCall(Real(all, reals, &set));
      break;
    case OptionType::kReals:
      PetscCall(Reals(all, 3, reals, &set));
      break;
    case OptionType::kTensor:
      PetscCall(Reals(all, 6, reals, &set));
      break;
    case OptionType::kInts:
      PetscCall(Ints(all, 3, ints, &set));
      break;
    case OptionType::kWord:
      PetscCall(Word(all, &word, &set));
      break;
    case OptionType::kNames:
      PetscCall(Names(all, &names, &set));
      break;
    case OptionType::kText:
    case OptionType::kViewer:
      break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool ParseReal(const std::string &word, double *value) {
  char *end = nullptr;
  if (word.empty() || std::isspace(static_cast<unsigned char>(word[0]))) return false;
  *value = std::strtod(word.c_str(), &end);
  return end == word.c_str() + word.size() && std::isfinite(*value);  // a zero byte inside is no end
}

/// An integer, which may be written as 1e6.
static bool ParseInt(const std::string &word, PetscInt *value) {
  double real = 0;
  char *end = nullptr;
  if (!ParseReal(word, &real) || real != std::floor(real)) return false;
  const double limit = -static_cast<double>(std::numeric_limits<PetscInt>::min());
  if (real < -limit || real >= limit) return false;
  const long long whole = std::strtoll(word.c_str(), &end, 10);  // exact where a double is not
  *value = static_cast<PetscInt>(*end == '\0' ? whole : static_cast<long long>(real));
  return true;
}

/// The words of a list, of which there must be n.
PetscErrorCode Options::Count(const Given &given, int n, std::vector<std::string> *words) {
  PetscFunctionBeginUser;
  *words = SplitList(given.text);
  CdemCheck(words->size() == static_cast<std::size_t>(n), comm_, "%s %s has %d value%s; give %s without spaces",
            given.spelled.c_str(), given.text.c_str(), static_cast<int>(words->size()), words->size() == 1 ? "" : "s",
            Expected(*given.spec).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Choice(const Given &given, const std::string &word) {
  PetscFunctionBeginUser;
  const std::vector<std::string> choices = SplitList(given.spec->choices);
  const bool there = choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end();
  if (there) PetscFunctionReturn(PETSC_SUCCESS);
  int changes;
  const std::string nearest = Nearest(word, choices, &changes);
  const std::string hint = LooksLike(word, changes) ? "; did you mean " + nearest + "?" : "";
  CdemCheck(there, comm_, "%s: there is no '%s'%s Give %s", given.spelled.c_str(), word.c_str(),
            hint.empty() ? "." : hint.c_str(), Expected(*given.spec).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Has(const OptionKey &key, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {}, true, &given));
  *set = given.set;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::GivenBy(const OptionKey &key, int *stage) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {}, true, &given));
  *stage = given.set ? -1 : -2;
  for (std::size_t i = 0; given.set && i < stages_.size(); ++i)  // a stage's option begins like this
    if (given.spelled.rfind("-stage_" + stages_[i] + "_", 0) == 0) *stage = static_cast<int>(i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Flag(const OptionKey &key, bool *value, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kFlag}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  const std::string word = Lower(given.text);
  const bool yes = word.empty() || word == "true" || word == "yes" || word == "on" || word == "1";
  const bool no = word == "false" || word == "no" || word == "off" || word == "0";
  CdemCheck(yes || no, comm_, "%s is '%s'; give true or false, or nothing for true", given.spelled.c_str(),
            given.text.c_str());
  *value = yes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Int(const OptionKey &key, PetscInt *value, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kInt}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  CdemCheck(ParseInt(given.text, value), comm_, "%s is '%s'; give %s", given.spelled.c_str(), given.text.c_str(),
            Expected(*given.spec).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Real(const OptionKey &key, double *value, bool *set) {
  Given given;
  double real = 0;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kReal}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  CdemCheck(ParseReal(given.text, &real), comm_, "%s is '%s'; give %s", given.spelled.c_str(), given.text.c_str(),
            Expected(*given.spec).c_str());
  *value = real;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Reals(const OptionKey &key, int n, double *values, bool *set) {
  Given given;
  std::vector<std::string> words;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kReals, OptionType::kTensor}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(given, n, &words));
  std::vector<double> read(words.size());
  for (std::size_t i = 0; i < words.size(); ++i)
    CdemCheck(ParseReal(words[i], &read[i]), comm_, "%s %s: '%s' is not a finite number; give %s",
              given.spelled.c_str(), given.text.c_str(), words[i].c_str(), Expected(*given.spec).c_str());
  std::copy(read.begin(), read.end(), values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Ints(const OptionKey &key, int n, PetscInt *values, bool *set) {
  Given given;
  std::vector<std::string> words;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kInts}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Count(given, n, &words));
  std::vector<PetscInt> read(words.size());
  for (std::size_t i = 0; i < words.size(); ++i)
    CdemCheck(ParseInt(words[i], &read[i]), comm_, "%s %s: '%s' is not an integer of %d bits; give %s",
              given.spelled.c_str(), given.text.c_str(), words[i].c_str(), static_cast<int>(8 * sizeof(PetscInt)),
              Expected(*given.spec).c_str());
  std::copy(read.begin(), read.end(), values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Word(const OptionKey &key, std::string *value, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kWord}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Choice(given, given.text));
  *value = given.text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Options::Text(const OptionKey &key, std::string *value, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kText, OptionType::kViewer}, set, &given));
  if (set) *set = given.set;
  if (given.set) *value = given.text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// What an option's name can carry on a command line and in YAML.
static bool IsName(const std::string &word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return c >= 128 || std::isalnum(c) || c == '_' || c == '-' || c == '.';
  });
}

PetscErrorCode Options::Names(const OptionKey &key, std::vector<std::string> *value, bool *set) {
  Given given;
  PetscFunctionBeginUser;
  PetscCall(Raw(key, {OptionType::kNames}, set, &given));
  if (set) *set = given.set;
  if (!given.set) PetscFunctionReturn(PETSC_SUCCESS);
  std::vector<std::string> names = SplitList(given.text), seen;
  for (const std::string &name : names) {
    CdemCheck(IsName(name), comm_, "%s %s: '%s' is no name; names are made of letters, digits, '_', '-' and '.'",
              given.spelled.c_str(), given.text.c_str(), name.c_str());
    CdemCheck(std::find(seen.begin(), seen.end(), Lower(name)) == seen.end(), comm_,
              "%s: '%s' is there twice (large and small letters are the same in options)", given.spelled.c_str(),
              name.c_str());
    seen.push_back(Lower(name));
    PetscCall(Choice(given, name));
  }
  *value = std::move(names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
