#include "forces/audit.hpp"

#include "forces/element_audit.hpp"
#include "forces/spring_audit.hpp"

namespace cdem {

bool Audits(const Tables &tables, const ElementTable &t) {
  bool dissipates = false;
  BlockLaws::Visit(t.law, [&](auto law) {
    using Law = decltype(law);
    dissipates = kBreaks<Law> || Law::kPlasticShear >= 0;
  });
  return dissipates || tables.beta != 0;
}

bool Audits(const Tables &tables, const SpringTable &t) {
  bool dissipates = false;
  JointLaws::Visit(t.law, [&](auto law) { dissipates = kDissipates<decltype(law)>; });
  return dissipates || tables.beta != 0;
}

AuditArrays StartAudit(const Tables &tables) {
  AuditArrays a;
  for (const ElementTable &t : tables.elements)
    a.element.emplace_back(Audits(tables, t) ? static_cast<std::size_t>(kElementWorks) * t.n_pad : 0, 0.0);
  for (const SpringTable &t : tables.springs) {
    a.spring.emplace_back(Audits(tables, t) ? static_cast<std::size_t>(kSpringWorks) * t.n_pad : 0, 0.0);
    a.viscous.emplace_back(tables.beta != 0 ? 3 * static_cast<std::size_t>(t.n_pad) : 0, 0.0);
  }
  a.node.assign(static_cast<std::size_t>(kNodeWorks) * tables.n_owned, 0.0);
  a.row.assign(static_cast<std::size_t>(kRowWorks) * tables.records.n, 0.0);
  const std::size_t local = static_cast<std::size_t>(tables.n_local);
  if (tables.beta != 0) a.speed.assign(3 * local, 0.0);
  a.dilatation.assign(local * tables.layers * (tables.beta != 0 ? 2 : 1), 0.0);
  return a;
}

AuditSums AuditSums::Of(const std::vector<double> &s) {
  AuditSums sums;
  sums.kinetic = s[kKineticSum];
  sums.strain = s[kStrainSum];
  sums.spring = s[kSpringSum];
  sums.weight = s[kWeightSum];
  sums.plastic = s[kElementSums0 + kPlastic];
  sums.fracture = s[kElementSums0 + kElementFracture] + s[kSpringSums0 + kSpringFracture];
  sums.beta = s[kElementSums0 + kElementBeta] + s[kSpringSums0 + kSpringBeta];
  sums.friction = s[kSpringSums0 + kFriction];
  sums.contact = s[kSpringSums0 + kContact];
  sums.alpha = s[kNodeSums0 + kAlpha];
  sums.local = s[kNodeSums0 + kLocal];
  sums.quiet = s[kRowSums0 + kQuietWork];
  sums.loads = s[kRowSums0 + kLoadWork];
  sums.wave = s[kRowSums0 + kWaveWork];
  sums.motion = s[kRowSums0 + kMotionWork];
  return sums;
}

}  // namespace cdem
