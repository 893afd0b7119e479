#include "physics/materials.hpp"

#include "core/error.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "physics/laws.hpp"
#include "physics/strength.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

void DeriveBlock(const Material &material, const double *property, double size, double *param) {
  BlockLaws::Visit(material.law, [&](auto law) {
    decltype(law)::Derive(property, size, param);
    if (material.intact) decltype(law)::MakeIntact(param);
  });
}

void DeriveJoint(const Joint &joint, const double *property, double *param) {
  JointLaws::Visit(joint.law, [&](auto law) {
    using Law = decltype(law);
    Law::Derive(property, param);
    if (joint.intact) Law::MakeIntact(param);
    if constexpr (Law::kMayKeepTension) param[Law::kKeepTension] = joint.keeps_tension;
  });
}

PetscErrorCode CarryOffset(MPI_Comm comm, const std::string &region, Material *material) {
  PetscFunctionBeginUser;
  const int law = BlockLaws::Carrier(material->law);
  bool at_corners = false;
  BlockLaws::Visit(material->law, [&](auto l) { at_corners = decltype(l)::kAtCorners; });
  CdemCheck(
      !at_corners || !material->restiffened, comm,
      "region '%s': blocks of discrete springs cannot change their law or stiffness in a stage: their forces would "
      "jump",
      region.c_str());
  CdemCheck(
      material->element != "onepoint" || !material->restiffened, comm,
      "region '%s': the form onepoint cannot change its stiffness in a stage (its hourglass forces would jump); use "
      "full or bbar",
      region.c_str());
  material->law = law;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CarryOffset(Joint *joint) {
  joint->law = JointLaws::Carrier(joint->law);
  std::fill_n(joint->param, kMaxParams, 0.0);
  DeriveJoint(*joint, joint->property, joint->param);
}

/// Divides strengths, and the tangents of angles of friction; dilation stays, but not above the friction.
template <class Law>
static void DivideStrength(double factor, double *property) {
  if (factor == 1) return;
  double friction = kPropertyInf;
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i) {
    const std::string key = Law::kProperties[i].key;
    if (key == "cohesion" || key == "tension" || key == "residual_cohesion" || key == "residual_tension")
      property[i] /= factor;
    if ((key == "friction" || key == "residual_friction") && std::isfinite(property[i]))
      property[i] = std::atan(std::tan(property[i] * kDegree) / factor) / kDegree;
    if (key == "friction") friction = property[i];
  }
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i)
    if (std::string(Law::kProperties[i].key) == "dilation") property[i] = std::min(property[i], friction);
}

/// Reads one property of a law and checks its range.
static PetscErrorCode ReadProperty(Options &options, const std::string &family, const std::string &name,
                                   const Property &property, double *value) {
  PetscFunctionBeginUser;
  const OptionKey key(family, name, property.key);
  if (*property.words) {
    const std::vector<std::string> words = SplitList(property.words);
    std::string word = words[static_cast<std::size_t>(property.fallback)];
    PetscCall(options.Word(key, &word));  // which refuses other words
    *value = static_cast<double>(std::find(words.begin(), words.end(), word) - words.begin());
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  bool set;
  *value = property.fallback;
  PetscCall(options.Real(key, value, &set));
  CdemCheck(set || !std::isnan(property.fallback), options.comm(), "%s '%s' has no %s: give %s%s%s",
            family == "block" ? "region" : "interface", name.c_str(), property.key, Options::Spelled(key).c_str(),
            *property.unit ? " in " : "", property.unit);
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
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

/// Reads all properties of a law and checks them together.
template <class Law>
static PetscErrorCode ReadLaw(Options &options, const std::string &family, const std::string &name, double *property) {
  PetscFunctionBeginUser;
  static_assert(Law::kProperties.size() <= kMaxProperties && Law::kParams <= kMaxParams, "raise the limit");
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i)
    PetscCall(ReadProperty(options, family, name, Law::kProperties[i], &property[i]));
  const std::string wrong = Law::Check(property);
  CdemCheck(wrong.empty(), options.comm(), "%s '%s': %s", family == "block" ? "region" : "interface", name.c_str(),
            wrong.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Reads -<family>_<name>_<property>_scatter for the properties that can.
template <std::size_t n>
static PetscErrorCode ReadScatters(Options &options, const std::string &family, const std::string &name,
                                   const std::array<Property, n> &properties, ScatterSet *scatter) {
  PetscFunctionBeginUser;
  PetscInt seed = 1;
  PetscCall(options.Int("seed", &seed));
  scatter->seed = seed;
  for (std::size_t i = 0; i < n; ++i) {
    bool set = false;
    if (Scatters(properties[i]))
      PetscCall(
          ReadScatter(options, {family, name, std::string(properties[i].key) + "_scatter"}, &scatter->of[i], &set));
    scatter->any = scatter->any || set;
  }
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

/// Laws of corners have an element form of their own, of their name.
static PetscErrorCode ReadForm(Options &options, const std::string &region, Material *material) {
  PetscFunctionBeginUser;
  const OptionKey key("block", region, "element");
  bool set, at_corners = false;
  std::string law;
  BlockLaws::Visit(material->law, [&](auto l) {
    at_corners = decltype(l)::kAtCorners;
    law = decltype(l)::kName;
  });
  PetscCall(options.Word(key, &material->element, &set));
  CdemCheck(!set || !at_corners, options.comm(),
            "region '%s': the law %s has an element form of its own, so there is no choosing %s; leave it out here",
            region.c_str(), law.c_str(), Options::Spelled(key).c_str());
  if (at_corners) material->element = law;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Stress from the start, and its gradient.
static PetscErrorCode ReadStress(Options &options, const std::string &region, Material *material) {
  PetscFunctionBeginUser;
  bool gradient;
  PetscCall(options.Reals({"block", region, "stress"}, 6, material->stress, &material->stressed));
  PetscCall(options.Reals({"block", region, "stress_gradient_z"}, 6, material->gradient, &gradient));
  material->stressed = material->stressed || gradient;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadMaterials(Options &options, const std::vector<std::string> &regions, const StrengthChange &change,
                             std::vector<Material> *materials, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  options.Declare("block", regions);
  materials->assign(regions.size(), Material());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Material &material = (*materials)[r];
    PetscCall(ReadLawName<BlockLaws>(options, "block", regions[r], &material.law));
    const Property density{"density", "kg/m^3", 0, kPropertyInf, kPropertyOpen};
    PetscCall(ReadProperty(options, "block", regions[r], density, &material.density));
    PetscErrorCode ierr = PETSC_SUCCESS;
    std::string remark;
    BlockLaws::Visit(material.law, [&](auto law) {
      ierr = ReadLaw<decltype(law)>(options, "block", regions[r], material.property);
      DivideStrength<decltype(law)>(change.factor, material.property);
      remark = decltype(law)::Remark(material.property);
    });
    PetscCall(ierr);
    if (remarks && !remark.empty()) remarks->push_back("region " + regions[r] + ": " + remark);
    material.intact = change.intact;
    DeriveBlock(material, material.property, 1, material.param);
    PetscCall(ReadStress(options, regions[r], &material));
    BlockLaws::Visit(material.law, [&](auto law) {
      ierr = ReadScatters(options, "block", regions[r], decltype(law)::kProperties, &material.scatter);
    });
    PetscCall(ierr);
    bool sized;
    PetscCall(options.Real({"block", regions[r], "scatter_volume"}, &material.scatter.volume, &sized));
    CdemCheck(!sized || (material.scatter.any && material.scatter.volume > 0), options.comm(),
              "%s is %g; it must be above 0, and goes with a weibull scatter",
              Options::Spelled({"block", regions[r], "scatter_volume"}).c_str(), material.scatter.volume);
    PetscCall(ReadForm(options, regions[r], &material));
    bool breaks = false;
    BlockLaws::Visit(material.law, [&](auto law) { breaks = decltype(law)::kJudgesMean; });
    if (breaks) PetscCall(options.Flag({"block", regions[r], "release_interfaces"}, &material.releases));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// What an interface has besides properties, and its parameters.
template <class Law>
static PetscErrorCode FinishJoint(Options &options, const std::string &name, Joint *joint,
                                  std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  const std::string adjusted = Law::Adjust(joint->property);
  if (!adjusted.empty()) remarks->push_back("interface " + name + ": " + adjusted);
  if constexpr (Law::kHistory) {
    std::string initial = "intact";
    PetscCall(options.Word({"interface", name, "initial"}, &initial));
    joint->broken = initial == "broken";
  }
  if constexpr (Law::kMayKeepTension) {
    PetscCall(options.Flag({"interface", name, "keep_tension"}, &joint->keeps_tension));
  }
  DeriveJoint(*joint, joint->property, joint->param);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, const StrengthChange &change,
                          std::vector<Joint> *joints, std::vector<std::string> *remarks) {
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
    JointLaws::Visit(joint.law, [&](auto law) {
      ierr = ReadLaw<decltype(law)>(options, "interface", name, joint.property);
      DivideStrength<decltype(law)>(change.factor, joint.property);
    });
    PetscCall(ierr);
    joint.intact = change.intact;
    joint.law = JointLaws::Choose(joint.law, joint.property);
    JointLaws::Visit(joint.law, [&](auto law) { ierr = FinishJoint<decltype(law)>(options, name, &joint, remarks); });
    PetscCall(ierr);
    JointLaws::Visit(joint.law, [&](auto law) {
      ierr = ReadScatters(options, "interface", name, decltype(law)::kProperties, &joint.scatter);
    });
    PetscCall(ierr);
    bool set;
    PetscCall(ReadScatter(options, {"interface", name, "kn_scatter"}, &joint.stiffness_scatter[0], &set));
    PetscCall(ReadScatter(options, {"interface", name, "ks_scatter"}, &joint.stiffness_scatter[1], &set));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
