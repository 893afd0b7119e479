#include "core/option_list.hpp"

#include "core/option_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace cdem {

// PETSc gives all options only as one string without quotes; the exact values come from two other calls that, unlike
// PetscOptionsFindPair alone, leave unread options unread.
PetscErrorCode ListOptions(std::vector<GivenOption> *options) {
  PetscFunctionBeginUser;
  PetscInt n_left = 0;
  char **names = nullptr, **values = nullptr, *all = nullptr;
  PetscCall(PetscOptionsLeftGet(nullptr, &n_left, &names, &values));
  std::map<std::string, const char *> left;
  for (PetscInt i = 0; i < n_left; ++i) left[names[i]] = values[i];
  PetscCall(PetscOptionsGetAll(nullptr, &all));
  const std::string text = all;
  PetscCall(PetscFree(all));
  for (std::size_t at = 0; at < text.size() && text[at] == '-';) {  // "-name " or "-name value "
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string name = text.substr(at + 1, space - at - 1);
    const char *value = nullptr;
    PetscBool used = PETSC_FALSE, set = PETSC_FALSE;
    const auto unread = left.find(name);
    PetscCall(PetscOptionsUsed(nullptr, name.c_str(), &used));
    if (unread != left.end()) {
      value = unread->second;
    } else if (used) {
      PetscCall(PetscOptionsFindPair(nullptr, nullptr, ("-" + name).c_str(), &value, &set));
    }
    std::string exact = value ? value : "";
    bool has_value = value != nullptr;
    at = space + 1;
    if (has_value && text.compare(at, exact.size(), exact) == 0) {
      at += exact.size() + 1;
    } else if (!used && unread == left.end()) {  // one of those that PETSc never lists as left: up to the next option
      std::size_t next = at;
      if (!(next < text.size() && text[next] == '-' && next + 1 < text.size() && std::isalpha(text[next + 1]))) {
        do next = text.find(" -", next + 1);
        while (next != std::string::npos && next + 2 < text.size() && !std::isalpha(text[next + 2]));
        next = std::min(next, text.size() - 1);
        exact = text.substr(at, next - at);
        has_value = !exact.empty();
        at = next + 1;
      }
    }
    if (name.rfind("options_file", 0) != 0 && name.rfind("options_string", 0) != 0)
      options->push_back({name, exact, has_value});
  }
  PetscCall(PetscOptionsLeftRestore(nullptr, &n_left, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

// Quotes in such a file have no escapes, '#' begins a comment even between them, and a value that looks like an option
// is refused.
std::string OptionLine(const GivenOption &option) {
  if (!option.has_value) return "-" + option.name + "\n";
  const std::string &value = option.value;
  PetscBool key = PETSC_FALSE;
  (void)PetscOptionsValidKey(value.c_str(), &key);
  if (key || value.find_first_of("\"#\t\r\n") != std::string::npos) {
    std::string shown = value;
    for (char &c : shown)
      if (c == '\n' || c == '\r') c = ' ';
    return "# no options file can hold this value: -" + option.name + " " + shown + "\n";
  }
  const bool quote = value.empty() || value.find(' ') != std::string::npos;
  return "-" + option.name + " " + (quote ? "\"" + value + "\"" : value) + "\n";
}

namespace {

constexpr char kStage[] = "stage_";

/// The stages that the options declare, in small letters.
std::vector<std::string> StagesOf(const std::vector<GivenOption> &options) {
  for (const GivenOption &option : options)
    if (Lower(option.name) == "stages") return SplitList(Lower(option.value));
  return {};
}

/// The stage of an option -stage_<name>_<inner>: its place among those declared (the longest name that fits), -1: none.
int StageOf(const std::vector<std::string> &stages, const std::string &option, std::string *inner) {
  int found = -1;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string head = kStage + stages[i] + "_";
    if (option.rfind(head, 0) != 0 || head.size() <= longest || head.size() == option.size()) continue;
    found = static_cast<int>(i);
    longest = head.size();
    *inner = option.substr(head.size());
  }
  return found;
}

/// The row that an option belongs to (of several families the one with the longest key), nullptr if none; everybodys: it
/// names nobody.
const OptionSpec *RowOf(const std::string &option, bool *everybodys) {
  *everybodys = true;
  for (const OptionSpec &spec : OptionSpecs()) {
    const OptionPattern pattern(spec);
    if ((pattern.Plain() || !pattern.key.empty()) && Lower(pattern.Spell("")) == option) return &spec;
  }
  *everybodys = false;
  std::string name;
  return FindFamily(option, &name);
}

/// The row of an option, also where a stage overrides it. [out] overrides: one does; everybodys: as above.
const OptionSpec *RowInStages(const std::vector<std::string> &stages, const std::string &option, bool *overrides,
                              bool *everybodys) {
  std::string inner;
  *overrides = StageOf(stages, option, &inner) >= 0;
  if (*overrides)
    if (const OptionSpec *spec = RowOf(inner, everybodys)) return spec;
  *overrides = false;
  return RowOf(option, everybodys);
}

bool IsOfScene(const OptionSpec &spec) {
  const OptionPattern pattern(spec);
  for (const char *free : {"ts_", "monitor_", "histor", "output", "checkpoint_", "restart", "help_"})
    if (pattern.family.rfind(free, 0) == 0) return false;
  for (const char *free : {"mesh", "deterministic", "device", "central_way", "central_mat_type", "elements_per_block",
                           "relax_ratio", "relax_kinetic", "relax_max_steps"})
    if (pattern.family == free) return false;
  return pattern.key != "file";
}

/// "0" and "0.0", "true" and nothing are the same values.
bool SameValue(const OptionSpec &spec, const std::string &a, const std::string &b) {
  const auto yes = [](const std::string &text) {
    const std::string word = Lower(text);
    return word.empty() || word == "true" || word == "yes" || word == "on" || word == "1";
  };
  if (spec.type == OptionType::kFlag) return yes(a) == yes(b);
  const std::vector<std::string> one = SplitList(a), other = SplitList(b);
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const auto &x, const auto &y) {
    double p, q;
    return x == y || (ParseReal(x, &p) && ParseReal(y, &q) && p == q);
  });
}

}  // namespace

std::vector<GivenOption> SceneOptions(const std::vector<GivenOption> &options) {
  std::vector<GivenOption> scene;
  const std::vector<std::string> stages = StagesOf(options);
  bool overrides, everybodys;
  for (const GivenOption &option : options) {
    const OptionSpec *spec = RowInStages(stages, Lower(option.name), &overrides, &everybodys);
    if (!spec || !IsOfScene(*spec)) continue;
    scene.push_back(option);
    for (char &c : scene.back().value)
      if (c == '\t' || c == '\n') c = ' ';
  }
  return scene;
}

std::string SceneDifference(const std::vector<GivenOption> &was, const std::vector<GivenOption> &now, int stage) {
  constexpr std::size_t kMost = 5;
  using Pair = std::pair<const GivenOption *, const GivenOption *>;
  std::map<std::string, Pair> pairs;
  std::vector<std::string> stages[2] = {StagesOf(was), StagesOf(now)};
  for (int side = 0; side < 2; ++side)
    for (const GivenOption &option : side == 0 ? was : now) {
      std::string inner;
      const std::string name = Lower(option.name);
      if (StageOf(stages[side], name, &inner) <= stage) (side == 0 ? pairs[name].first : pairs[name].second) = &option;
    }
  for (std::vector<std::string> &names : stages)
    if (names.size() > static_cast<std::size_t>(stage) + 1) names.resize(static_cast<std::size_t>(stage) + 1);
  std::vector<std::string> lines;
  for (const auto &[name, pair] : pairs) {
    bool overrides, everybodys;
    const OptionSpec *spec = RowInStages(stages[pair.first ? 0 : 1], name, &overrides, &everybodys);
    if (!spec || (name == "stages" && stages[0] == stages[1])) continue;
    const auto [before, after] = pair;
    const bool alone = everybodys || pairs.count(Lower(OptionPattern(*spec).Spell(""))) == 0;
    const bool may_fall_back = alone && !overrides && *spec->fallback;
    if (before && after && name != "stages" && SameValue(*spec, before->value, after->value)) continue;
    if (!(before && after) && may_fall_back && SameValue(*spec, (before ? before : after)->value, spec->fallback))
      continue;
    const auto said = [](const GivenOption *option) {
      return !option ? std::string("not given") : option->has_value ? option->value : std::string("given");
    };
    const std::string line = "-" + name + " was " + said(before) + " and is " + said(after) + " now";
    lines.insert(name == "stages" ? lines.begin() : lines.end(), line);  // other stages say the most
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(lines.size(), kMost); ++i) text += (i ? "; " : "") + lines[i];
  if (lines.size() > kMost) text += "; and " + std::to_string(lines.size() - kMost) + " more";
  return text;
}

}  // namespace cdem
