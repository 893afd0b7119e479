#include "core/option_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace cdem {

OptionPattern::OptionPattern(const OptionSpec &spec) : family(spec.name) {
  const std::string name = spec.name;
  const std::size_t open = name.find("_<"), close = name.find('>');
  if (open == std::string::npos) return;
  family = name.substr(0, open);
  noun = name.substr(open + 2, close - open - 2);
  if (noun == "name") noun = family;
  if (close + 1 < name.size()) key = name.substr(close + 2);
}

std::string OptionPattern::Spell(const std::string &name) const {
  return family + (name.empty() ? "" : "_" + name) + (key.empty() ? "" : "_" + key);
}

const OptionSpec *FindOption(const OptionKey &key) {
  const bool plain = key.name.empty() && key.key.empty();
  for (const OptionSpec &spec : OptionSpecs()) {
    if (std::strncmp(spec.name, key.family.c_str(), key.family.size()) != 0) continue;
    const OptionPattern pattern(spec);
    if (pattern.Plain() == plain && pattern.family == key.family && pattern.key == key.key) return &spec;
  }
  return nullptr;
}

const OptionSpec *FindFamily(const std::string &option, std::string *name) {
  const OptionSpec *found = nullptr;
  std::size_t most = 0;
  for (const OptionSpec &spec : OptionSpecs()) {
    const OptionPattern pattern(spec);
    const std::string head = pattern.family + "_", tail = pattern.key.empty() ? "" : "_" + pattern.key;
    if (pattern.Plain() || option.size() <= head.size() + tail.size() || (found && tail.size() <= most)) continue;
    if (Lower(option.substr(0, head.size())) != head) continue;
    if (Lower(option.substr(option.size() - tail.size())) != tail) continue;
    *name = option.substr(head.size(), option.size() - head.size() - tail.size());
    most = tail.size();
    found = &spec;
  }
  return found;
}

std::string Expected(const OptionSpec &spec) {
  const std::string unit = *spec.unit ? std::string(" [") + spec.unit + "]" : "";
  const std::string choices = ListNames(SplitList(spec.choices));
  switch (spec.type) {
    case OptionType::kFlag:
      return "true or false";
    case OptionType::kInt:
      return "an integer" + unit;
    case OptionType::kReal:
      return "a number" + unit;
    case OptionType::kReals:
      return "3 numbers" + unit + " joined by commas";
    case OptionType::kTensor:
      return "6 numbers" + unit + " (xx, yy, zz, xy, yz, xz) joined by commas";
    case OptionType::kInts:
      return "3 integers" + unit + " joined by commas";
    case OptionType::kWord:
      return "one of " + choices;
    case OptionType::kNames:
      return *spec.choices ? "names out of " + choices : "names joined by commas";
    case OptionType::kText:
      return "a text";
    case OptionType::kViewer:
      return "a PETSc viewer, such as ascii:file";
  }
  return "";
}

std::string Plural(const std::string &noun) {
  if (!noun.empty() && noun.back() == 'y') return noun.substr(0, noun.size() - 1) + "ies";
  return noun + "s";
}

std::string Lower(std::string text) {
  for (char &c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

std::vector<std::string> SplitList(const std::string &text) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    std::size_t first = at, last = end;
    while (first < last && std::isspace(static_cast<unsigned char>(text[first]))) ++first;
    while (last > first && std::isspace(static_cast<unsigned char>(text[last - 1]))) --last;
    parts.push_back(text.substr(first, last - first));
    at = end + 1;
  }
  return parts;
}

std::string ListNames(const std::vector<std::string> &names) {
  constexpr std::size_t kMost = 20;
  std::string all;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) all += (i ? ", " : "") + names[i];
  if (names.size() > kMost) all += ", ... (" + std::to_string(names.size()) + ")";
  return all;
}

// PETSc drops "_<digits>_" from a name that it does not find: only then the text of the whole database must decide.
static bool HasNumberInside(const std::string &name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != '_') continue;
    std::size_t j = i + 1;
    while (j < name.size() && std::isdigit(static_cast<unsigned char>(name[j]))) ++j;
    if (j > i + 1 && j < name.size() && name[j] == '_') return true;
  }
  return false;
}

PetscErrorCode FindGiven(const std::string &name, bool *set, const char **value) {
  PetscBool found = PETSC_FALSE;
  PetscFunctionBeginUser;
  *value = nullptr;
  PetscCall(PetscOptionsFindPair(nullptr, nullptr, ("-" + name).c_str(), value, &found));
  *set = found;
  if (*set && HasNumberInside(name)) {
    char *all = nullptr;
    PetscCall(PetscOptionsGetAll(nullptr, &all));  // "-name value -name -name value "
    *set = Lower(std::string(" ") + all + " ").find(Lower(" -" + name + " ")) != std::string::npos;
    PetscCall(PetscFree(all));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Distance of Damerau and Levenshtein with adjacent swaps (optimal string alignment).
static int Changes(const std::string &a, const std::string &b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string Nearest(const std::string &name, const std::vector<std::string> &candidates, int *changes) {
  std::string best;
  *changes = PETSC_MAX_OPTION_NAME;
  for (const std::string &candidate : candidates) {
    const int n = Changes(Lower(name), Lower(candidate));
    if (n < *changes) *changes = n, best = candidate;
  }
  return best;
}

bool LooksLike(const std::string &name, int changes) {
  return changes <= std::clamp(static_cast<int>(name.size()) / 3, 1, 4);
}

}  // namespace cdem
