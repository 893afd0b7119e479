// Laws and numbers of interfaces.
#include "physics/laws.hpp"
#include "physics/materials.hpp"
#include "physics/read_law.hpp"

#include <cstdio>
#include <functional>

namespace cdem {

void DeriveJoint(const Joint &joint, const double *property, double *param) {
  JointLaws::Visit(joint.law, [&](auto law) {
    using Law = decltype(law);
    Law::Derive(property, param);
    if (joint.intact) Law::MakeIntact(param);
    if constexpr (Law::kMayKeepTension) param[Law::kKeepTension] = joint.keeps_tension;
  });
}

void CarryOffset(Joint *joint) {
  joint->law = JointLaws::Carrier(joint->law);
  std::fill_n(joint->param, kMaxParams, 0.0);
  DeriveJoint(*joint, joint->property, joint->param);
}

/// "region 'a'" or "regions 'a' and 'b'".
static std::string Named(const Neighbours &blocks, const RegionPair &pair) {
  const std::string first = "'" + blocks.regions[pair[0]] + "'";
  return pair[0] == pair[1] ? "region " + first : "regions " + first + " and '" + blocks.regions[pair[1]] + "'";
}

/// Gives a face between two regions the strengths that the scene does not give: the smaller of the two blocks'.
template <class Law>
static PetscErrorCode TakeStrengths(Options &options, const std::string &name, const Neighbours &blocks,
                                    const RegionPair &pair, const std::vector<std::size_t> &missing, double *property) {
  PetscFunctionBeginUser;
  for (std::size_t i : missing) {
    const Property &p = Law::kProperties[i];
    const std::string spelled = Options::Spelled({"interface", name, p.key}) + " in " + p.unit;
    property[i] = std::min(blocks.materials[pair[0]].strength[i], blocks.materials[pair[1]].strength[i]);
    CdemCheck(std::isfinite(property[i]), options.comm(),
              "interface '%s' has no %s, and neither have the blocks beside it (%s): give %s", name.c_str(), p.key,
              Named(blocks, pair).c_str(), spelled.c_str());
    CdemCheck(p.Allows(property[i]), options.comm(),
              "interface '%s' has no %s, and the law cannot take %g from the blocks beside it (%s): give %s",
              name.c_str(), p.key, property[i], Named(blocks, pair).c_str(), spelled.c_str());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// "tension 1e+05 Pa, friction 30 to 35 degrees".
template <class Law>
static std::string Range(const std::vector<std::size_t> &missing, const std::vector<PropertyRow> &rows) {
  std::string text;
  for (std::size_t i : missing) {
    double low = kPropertyInf, high = 0;
    for (const PropertyRow &row : rows) low = std::min(low, row[i]), high = std::max(high, row[i]);
    char one[120];
    if (low < high)
      std::snprintf(one, sizeof one, "%s %g to %g %s", Law::kProperties[i].key, low, high, Law::kProperties[i].unit);
    else
      std::snprintf(one, sizeof one, "%s %g %s", Law::kProperties[i].key, low, Law::kProperties[i].unit);
    text += (text.empty() ? "" : ", ") + std::string(one);
  }
  return text;
}

/// Reads the properties of an interface's law: one row, or where blocks of different strength stand in for what is not
/// given, one for each pair of regions beside it.
template <class Law>
static PetscErrorCode ReadRows(Options &options, const std::string &name, const Neighbours &blocks,
                               const std::vector<RegionPair> &sides, double factor, Joint *joint,
                               std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  std::vector<std::size_t> missing;
  PetscCall(ReadLaw<Law>(options, "interface", name, joint->property, &missing));
  if (missing.empty()) {
    DivideStrength<Law>(factor, joint->property);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  std::vector<PropertyRow> rows;
  for (const RegionPair &pair : sides) {
    PropertyRow row;
    std::copy_n(joint->property, kMaxProperties, row.begin());
    PetscCall(TakeStrengths<Law>(options, name, blocks, pair, missing, row.data()));
    const std::string wrong = Law::Check(row.data());
    CdemCheck(wrong.empty(), options.comm(), "interface '%s', with the strengths of the blocks beside it (%s): %s",
              name.c_str(), Named(blocks, pair).c_str(), wrong.c_str());
    rows.push_back(row);
  }
  remarks->push_back("interface " + name + ": " + Range<Law>(missing, rows) + ", of the weaker block beside it");
  for (PropertyRow &row : rows) DivideStrength<Law>(factor, row.data());
  std::copy_n(rows[0].begin(), kMaxProperties, joint->property);
  if (std::adjacent_find(rows.begin(), rows.end(), std::not_equal_to<>()) != rows.end())
    for (std::size_t k = 0; k < rows.size(); ++k) joint->of_sides[sides[k]] = rows[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Says what it changes, but not that rounding has moved what is at its limit.
template <class Law>
static void AdjustRow(const std::string &name, double *property, std::vector<std::string> *remarks) {
  PropertyRow before;
  std::copy_n(property, kMaxProperties, before.begin());
  const std::string adjusted = Law::Adjust(property);
  if (!adjusted.empty() && !std::equal(before.begin(), before.end(), property))
    remarks->push_back("interface " + name + ": " + adjusted);
}

/// What an interface has besides properties, and its parameters.
template <class Law>
static PetscErrorCode FinishJoint(Options &options, const std::string &name, Joint *joint,
                                  std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  AdjustRow<Law>(name, joint->property, remarks);
  for (auto &[pair, row] : joint->of_sides) AdjustRow<Law>(name, row.data(), remarks);
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

PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, const Neighbours &blocks,
                          const StrengthChange &change, std::vector<Joint> *joints, std::vector<std::string> *remarks) {
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
      ierr = ReadRows<decltype(law)>(options, name, blocks, blocks.sides[i], change.factor, &joint, remarks);
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
