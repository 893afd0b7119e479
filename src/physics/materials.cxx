#include "physics/materials.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "physics/laws.hpp"

#include <cmath>

namespace cdem {

/// Reads one property of a law and checks its range.
static PetscErrorCode ReadProperty(Options &options, const std::string &family, const std::string &name,
                                   const Property &property, double *value) {
  PetscFunctionBeginUser;
  const OptionKey key(family, name, property.key);
  bool set;
  PetscCall(options.Real(key, value, &set));
  CdemCheck(set, options.comm(), "%s '%s' has no %s: give %s%s%s", family == "block" ? "region" : "interface",
            name.c_str(), property.key, Options::Spelled(key).c_str(), *property.unit ? " in " : "", property.unit);
  const char *left = property.bounds == kPropertyOpen ? "above" : "at least";
  const char *right = property.bounds == kPropertyOpen ? "below" : "at most";
  if (std::isinf(property.high))
    CdemCheck(property.Allows(*value), options.comm(), "%s is %g; it must be %s %g", Options::Spelled(key).c_str(),
              *value, left, property.low);
  else
    CdemCheck(property.Allows(*value), options.comm(), "%s is %g; it must be %s %g and %s %g",
              Options::Spelled(key).c_str(), *value, left, property.low, right, property.high);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Reads all properties of a law and derives the parameters of its point function.
template <class Law>
static PetscErrorCode ReadLaw(Options &options, const std::string &family, const std::string &name, double *param) {
  PetscFunctionBeginUser;
  double value[Law::kProperties.size() + 1] = {};
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i)
    PetscCall(ReadProperty(options, family, name, Law::kProperties[i], &value[i]));
  Law::Derive(value, param);
  PetscFunctionReturn(PETSC_SUCCESS);
}

template <class List>
static PetscErrorCode ReadLawName(Options &options, const std::string &family, const std::string &name, int *law) {
  PetscFunctionBeginUser;
  const OptionKey key(family, name, "law");
  std::string word = "elastic";
  PetscCall(options.Word(key, &word));
  *law = List::Find(word);
  CdemCheck(*law >= 0, options.comm(), "%s: there is no law '%s'; the laws are: %s", Options::Spelled(key).c_str(),
            word.c_str(), List::Names().c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadMaterials(Options &options, const std::vector<std::string> &regions,
                             std::vector<Material> *materials) {
  PetscFunctionBeginUser;
  options.Declare("block", regions);
  materials->assign(regions.size(), Material());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Material &material = (*materials)[r];
    PetscCall(ReadLawName<BlockLaws>(options, "block", regions[r], &material.law));
    const Property density{"density", "kg/m^3", 0, kPropertyInf, kPropertyOpen};
    PetscCall(ReadProperty(options, "block", regions[r], density, &material.density));
    double elastic[Elastic::kParams] = {};
    PetscCall(ReadLaw<Elastic>(options, "block", regions[r], elastic));
    material.lambda = elastic[Elastic::kLambda];
    material.mu = elastic[Elastic::kMu];
    PetscErrorCode ierr = PETSC_SUCCESS;
    BlockLaws::Visit(material.law,
                     [&](auto law) { ierr = ReadLaw<decltype(law)>(options, "block", regions[r], material.param); });
    PetscCall(ierr);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, std::vector<Joint> *joints,
                          std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  joints->assign(names.size(), Joint());
  for (std::size_t i = 0; i < names.size(); ++i) {
    Joint &joint = (*joints)[i];
    const std::string &name = names[i];
    PetscCall(ReadLawName<JointLaws>(options, "interface", name, &joint.law));
    const std::pair<const char *, double *> stiffness[] = {
        {"kn", &joint.kn}, {"ks", &joint.ks}, {"stiffness_factor", &joint.stiffness_factor}};
    for (const auto &[key, value] : stiffness) {
      bool set;
      PetscCall(options.Real({"interface", name, key}, value, &set));
      CdemCheck(!set || *value > 0, options.comm(), "%s is %g; it must be above 0",
                Options::Spelled({"interface", name, key}).c_str(), *value);
    }
    PetscErrorCode ierr = PETSC_SUCCESS;
    JointLaws::Visit(joint.law,
                     [&](auto law) { ierr = ReadLaw<decltype(law)>(options, "interface", name, joint.param); });
    PetscCall(ierr);
    if (joint.law == JointLaws::Find(JointBrittle::kName)) {
      std::string initial = "intact";
      bool keep = false;
      PetscCall(options.Word({"interface", name, "initial"}, &initial));
      PetscCall(options.Flag({"interface", name, "keep_tension"}, &keep));
      joint.broken = initial == "broken";
      joint.param[JointBrittle::kKeepTension] = keep;
      const double tan_phi = joint.param[JointBrittle::kTanPhi], c = joint.param[JointBrittle::kCohesion];
      double &tension = joint.param[JointBrittle::kTension];
      if (tension * tan_phi > c) {
        tension = c / tan_phi;
        remarks->push_back("interface " + name +
                           ": tension cut to cohesion / tan(friction) = " + std::to_string(tension) + " Pa");
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
