#include "physics/law_options.hpp"

#include "core/options.hpp"
#include "physics/laws.hpp"

namespace cdem {

template <class Law>
static void RegisterLaw(const std::string &prefix) {
  const std::string law = prefix + "law";
  AddOption({law.c_str(), OptionType::kWord, "", "elastic", "law", Law::kName});
  for (const Property &p : Law::kProperties) {
    const std::string name = prefix + p.key, required = std::string("required by ") + Law::kName;
    AddOption({name.c_str(), OptionType::kReal, p.unit, required.c_str(), p.text, ""});
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
