#include "physics/law_options.hpp"

#include "core/option_names.hpp"
#include "core/options.hpp"
#include "physics/laws.hpp"

#include <cmath>
#include <cstdio>

namespace cdem {

static std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

template <class Law>
static void RegisterLaw(const std::string &prefix) {
  const std::string law = prefix + "law";
  AddOption({law.c_str(), OptionType::kWord, "", "elastic", "law", Law::kName});
  for (const Property &p : Law::kProperties) {
    const std::string name = prefix + p.key;
    std::string fallback = std::string("required by ") + Law::kName;
    if (!std::isnan(p.fallback))
      fallback = *p.words ? SplitList(p.words)[static_cast<int>(p.fallback)] : Text(p.fallback);
    AddOption(
        {name.c_str(), *p.words ? OptionType::kWord : OptionType::kReal, p.unit, fallback.c_str(), p.text, p.words});
  }
}

template <class... Laws>
static void RegisterList(LawList<Laws...>, const std::string &prefix) {
  (RegisterLaw<Laws>(prefix), ...);
}

void RegisterLawOptions() {
  RegisterList(BlockLaws(), "block_<region>_");
  RegisterList(JointLaws(), "interface_<name>_");
}

}  // namespace cdem
