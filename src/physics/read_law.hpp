// How laws and their properties are read from the options; for the materials of blocks and of interfaces.
#pragma once
#include "core/error.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "physics/materials.hpp"
#include "physics/strength.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace cdem {

/// Divides strengths, and the tangents of angles of friction; dilation stays, but not above the friction.
template <class Law>
void DivideStrength(double factor, double *property) {
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

/// Reads one property of a law and checks its range. [out] missing: it is needed and not given; NULL: that is an error.
PetscErrorCode ReadProperty(Options &options, const std::string &family, const std::string &name,
                            const Property &property, double *value, bool *missing = nullptr);

/// An interface law's strength that the blocks beside it may give.
template <class Law>
constexpr bool MayComeFromBlocks(std::size_t i) {
  if constexpr (std::is_base_of_v<JointLawDefaults, Law>) return i < Law::kFromBlocks;
  return false;
}

/// Reads all properties of a law and checks them together. [out] missing: those that blocks may have instead; if there are
/// any, the check is left to the caller. NULL: none may be missing.
template <class Law>
PetscErrorCode ReadLaw(Options &options, const std::string &family, const std::string &name, double *property,
                       std::vector<std::size_t> *missing = nullptr) {
  PetscFunctionBeginUser;
  static_assert(Law::kProperties.size() <= kMaxProperties && Law::kParams <= kMaxParams, "raise the limit");
  for (std::size_t i = 0; i < Law::kProperties.size(); ++i) {
    bool lacks = false;
    const bool may = missing && MayComeFromBlocks<Law>(i);
    PetscCall(ReadProperty(options, family, name, Law::kProperties[i], &property[i], may ? &lacks : nullptr));
    if (lacks) missing->push_back(i);
  }
  if (missing && !missing->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  const std::string wrong = Law::Check(property);
  CdemCheck(wrong.empty(), options.comm(), "%s '%s': %s", family == "block" ? "region" : "interface", name.c_str(),
            wrong.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Reads -<family>_<name>_<property>_scatter for the properties that can.
template <std::size_t n>
PetscErrorCode ReadScatters(Options &options, const std::string &family, const std::string &name,
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
PetscErrorCode ReadLawName(Options &options, const std::string &family, const std::string &name, int *law) {
  PetscFunctionBeginUser;
  const OptionKey key(family, name, "law");
  std::string word = "elastic";
  PetscCall(options.Word(key, &word));
  *law = List::Find(word);
  CdemCheck(*law >= 0, options.comm(), "%s: there is no law '%s'; the laws are: %s", Options::Spelled(key).c_str(),
            word.c_str(), List::Names().c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
