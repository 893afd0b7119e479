#include "physics/law_options.hpp"

#include "core/option_names.hpp"
#include "core/options.hpp"
#include "physics/laws.hpp"
#include "physics/scatter.hpp"

#include <cmath>
#include <cstdio>

namespace cdem {

static std::string Text(double value) {
  if (std::isinf(value)) return "no end";
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
    if (*p.fallback_text)
      fallback = p.fallback_text;
    else if (!std::isnan(p.fallback))
      fallback = *p.words ? SplitList(p.words)[static_cast<int>(p.fallback)] : Text(p.fallback);
    AddOption(
        {name.c_str(), *p.words ? OptionType::kWord : OptionType::kReal, p.unit, fallback.c_str(), p.text, p.words});
    if (Scatters(p)) {
      const std::string
          scatter = name + "_scatter",
          text = "how " + std::string(p.key) +
                 " varies about its value, the mean: `weibull:m`, `normal:s`, `uniform:d` (over the mean), cut at 0";
      AddOption({scatter.c_str(), OptionType::kText, "", "", text.c_str(), ""});
    }
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
