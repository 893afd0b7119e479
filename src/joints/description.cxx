// Options and files to descriptions of joint sets.
#include "core/error.hpp"
#include "core/options.hpp"
#include "joints/network.hpp"

#include <algorithm>
#include <sstream>

namespace cdem {

namespace {

struct LawWord {
  const char *word, *form;
  DiameterLaw::Kind kind;
  int numbers;
};
constexpr LawWord kLaws[] = {{"fixed", "fixed:d", DiameterLaw::kFixed, 1},
                             {"uniform", "uniform:min,max", DiameterLaw::kUniform, 2},
                             {"lognormal", "lognormal:mean,sd", DiameterLaw::kLogNormal, 2},
                             {"power", "power:a,min,max", DiameterLaw::kPower, 3}};

std::vector<std::string> Words(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// "power:2.5,1,10".
PetscErrorCode ParseDiameter(MPI_Comm comm, const std::string &spelled, const std::string &text, DiameterLaw *law) {
  PetscFunctionBeginUser;
  const std::size_t colon = text.find(':');
  const LawWord *found = nullptr;
  for (const LawWord &known : kLaws)
    if (text.substr(0, colon) == known.word) found = &known;
  CdemCheck(found && colon != std::string::npos, comm,
            "%s %s: not understood; it is fixed:d, uniform:min,max, lognormal:mean,sd or power:a,min,max (m)",
            spelled.c_str(), text.c_str());
  const std::vector<std::string> words = Words(text.substr(colon + 1));
  CdemCheck(static_cast<int>(words.size()) == found->numbers, comm, "%s %s has %d number%s; it is %s (m)",
            spelled.c_str(), text.c_str(), static_cast<int>(words.size()), words.size() == 1 ? "" : "s", found->form);
  law->kind = found->kind;
  for (int i = 0; i < found->numbers; ++i)
    CdemCheck(ParseReal(words[i], &law->p[i]), comm, "%s %s: '%s' is not a finite number; it is %s (m)",
              spelled.c_str(), text.c_str(), words[i].c_str(), found->form);
  const double *p = law->p;
  const bool range = found->kind == DiameterLaw::kUniform || found->kind == DiameterLaw::kPower;
  const int low = found->kind == DiameterLaw::kPower;  // index of min
  CdemCheck(!range || (p[low] > 0 && p[low + 1] > p[low]), comm,
            "%s %s: min must be above 0, and max above min (it is %s)", spelled.c_str(), text.c_str(), found->form);
  CdemCheck(range || (p[0] > 0 && (found->numbers == 1 || p[1] > 0)), comm, "%s %s: what %s gives must be above 0",
            spelled.c_str(), text.c_str(), found->form);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// A number that must be given and lie from low to high.
PetscErrorCode Angle(Options &options, const OptionKey &key, double high, double *value) {
  PetscFunctionBeginUser;
  bool set;
  PetscCall(options.Real(key, value, &set));
  const std::string spelled = Options::Spelled(key);
  CdemCheck(set, options.comm(), "joint set '%s' is drawn at random: give %s, in degrees from 0 to %g",
            key.name.c_str(), spelled.c_str(), high);
  CdemCheck(*value >= 0 && *value <= high, options.comm(), "%s is %g; it is in degrees from 0 to %g", spelled.c_str(),
            *value, high);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadLaw(Options &options, const std::string &name, JointLaw *law) {
  PetscFunctionBeginUser;
  bool set;
  std::string text;
  PetscCall(Angle(options, {"joint", name, "dip"}, 90, &law->dip));
  PetscCall(Angle(options, {"joint", name, "dip_direction"}, 360, &law->dip_direction));
  const OptionKey fisher("joint", name, "fisher"), diameter("joint", name, "diameter");
  PetscCall(options.Real(fisher, &law->fisher, &set));
  CdemCheck(!set || law->fisher >= 0, options.comm(),
            "%s is %g; it is Fisher's kappa, at least 0 (leave it out for parallel discs)",
            Options::Spelled(fisher).c_str(), law->fisher);
  const std::string spelled = Options::Spelled(diameter);
  PetscCall(options.Text(diameter, &text, &set));
  CdemCheck(set, options.comm(),
            "joint set '%s' is drawn at random: give %s as fixed:d, uniform:min,max, lognormal:mean,sd or "
            "power:a,min,max (m)",
            name.c_str(), spelled.c_str());
  PetscCall(ParseDiameter(options.comm(), spelled, text, &law->diameter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadSet(const Mesh &mesh, Options &options, JointSet *set) {
  PetscFunctionBeginUser;
  const OptionKey file("joint", set->name, "file"), p32("joint", set->name, "p32"), count("joint", set->name, "count"),
      within("joint", set->name, "within");
  bool given[3], confined;
  std::string region;
  PetscCall(options.Text(file, &set->file, &given[0]));
  PetscCall(options.Real(p32, &set->p32, &given[1]));
  PetscCall(options.Real(count, &set->count, &given[2]));
  CdemCheck(given[0] + given[1] + given[2] == 1, options.comm(),
            "joint set '%s' has %s: give one of %s (disc area per volume, m^2/m^3), %s (centres per m^3) and %s",
            set->name.c_str(), given[0] + given[1] + given[2] ? "more than one source of discs" : "no source of discs",
            Options::Spelled(p32).c_str(), Options::Spelled(count).c_str(), Options::Spelled(file).c_str());
  CdemCheck(!given[1] || set->p32 > 0, options.comm(), "%s is %g; it must be above 0", Options::Spelled(p32).c_str(),
            set->p32);
  CdemCheck(!given[2] || set->count > 0, options.comm(), "%s is %g; it must be above 0",
            Options::Spelled(count).c_str(), set->count);
  PetscCall(options.Text(within, &region, &confined));
  if (confined) {
    set->region = Mesh::Find(mesh.regions, region);
    CdemCheck(set->region >= 0, options.comm(), "%s %s: the mesh has no region '%s'; its regions are: %s",
              Options::Spelled(within).c_str(), region.c_str(), region.c_str(), Joined(mesh.regions).c_str());
  }
  if (given[0])
    PetscCall(ReadDiscs(options.comm(), Options::Spelled(file), set->file, &set->discs));
  else
    PetscCall(ReadLaw(options, set->name, &set->law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode ReadJointSets(const Mesh &mesh, Options &options, std::vector<JointSet> *sets) {
  PetscFunctionBeginUser;
  std::vector<std::string> names;
  PetscCall(options.Names("joints", &names));
  options.Declare("joint", names);
  sets->resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    (*sets)[i].name = names[i];
    PetscCall(ReadSet(mesh, options, &(*sets)[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
