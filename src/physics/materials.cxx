#include "physics/materials.hpp"

#include "physics/laws.hpp"
#include "physics/read_law.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

void DeriveBlock(const Material &material, const double *property, double size, double *param) {
  BlockLaws::Visit(material.law, [&](auto law) {
    decltype(law)::Derive(property, size, param);
    if (material.intact) decltype(law)::MakeIntact(param);
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
  CdemCheck(law >= 0, comm,
            "region '%s' is under stress from the start or changes its stiffness in a stage: this cdem was built with "
            "the elastic laws alone (CDEM_ELASTIC_ONLY), which cannot",
            region.c_str());
  material->law = law;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadProperty(Options &options, const std::string &family, const std::string &name,
                            const Property &property, double *value, bool *missing) {
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
  const bool lacks = !set && std::isnan(property.fallback);
  if (missing) *missing = lacks;
  CdemCheck(!lacks || missing, options.comm(), "%s '%s' has no %s: give %s%s%s",
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

/// What a region's law offers to interfaces that have no strengths of their own. A tensile strength counts up to the apex
/// of Mohr-Coulomb's surface.
template <class Law>
static void OfferStrength(const double *property, double *strength) {
  std::fill_n(strength, kStrengths, kPropertyInf);
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i)
    for (int k = 0; k < kStrengths; ++k)
      if (std::string(Law::kProperties[i].key) == kStrengthKeys[k]) strength[k] = property[i];
  const double cohesion = strength[kStrengthCohesion], friction = strength[kStrengthFriction];
  if (std::isfinite(cohesion) && std::isfinite(friction))
    strength[kStrengthTension] = std::min(strength[kStrengthTension], MohrCoulombApex(cohesion, friction));
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
      OfferStrength<decltype(law)>(material.property, material.strength);
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

}  // namespace cdem
