#include "energy.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

const std::vector<BalanceTerm> kBalanceTerms = {
    {"plastic", [](const Balance &b) { return b.sums.plastic; }},
    {"friction", [](const Balance &b) { return b.sums.friction; }},
    {"fracture", [](const Balance &b) { return b.sums.fracture; }},
    {"contact", [](const Balance &b) { return b.sums.contact; }},
    {"damping_alpha", [](const Balance &b) { return b.sums.alpha; }},
    {"damping_beta", [](const Balance &b) { return b.sums.beta; }},
    {"damping_local", [](const Balance &b) { return b.sums.local; }},
    {"damping_quiet", [](const Balance &b) { return b.sums.quiet; }},
    {"damping_stops", [](const Balance &b) { return b.stops; }},
    {"work_gravity", [](const Balance &b) { return b.gravity; }},
    {"work_loads", [](const Balance &b) { return b.sums.loads; }},
    {"work_wave", [](const Balance &b) { return b.sums.wave; }},
    {"work_motion", [](const Balance &b) { return b.sums.motion; }},
    {"changed", [](const Balance &b) { return b.changed; }},
    {"initial", [](const Balance &b) { return b.initial; }},
    {"error", [](const Balance &b) { return b.Error(); }},
};

/// The sums that are added up along the path, which stages carry on.
static constexpr double AuditSums::*kPath[] = {&AuditSums::plastic, &AuditSums::friction, &AuditSums::fracture,
                                               &AuditSums::contact, &AuditSums::alpha,    &AuditSums::beta,
                                               &AuditSums::local,   &AuditSums::quiet,    &AuditSums::loads,
                                               &AuditSums::wave,    &AuditSums::motion};

double Balance::Dissipated() const {
  return sums.plastic + sums.friction + sums.fracture + sums.contact + sums.alpha + sums.beta + sums.local +
         sums.quiet + stops;
}

double Balance::Scale() const {
  const double given =
      std::fabs(initial) + std::fabs(gravity) + std::fabs(sums.loads) + std::fabs(sums.wave) + std::fabs(sums.motion);
  return std::max(given, std::fabs(Stored()) + std::fabs(Dissipated()) + std::fabs(changed));
}

double Balance::Error() const {
  const double missing = std::fabs(Missing());
  return missing > 0 ? missing / Scale() : missing;  // not a number stays one
}

void EnergyBook::Begin(const AuditSums &sums) {
  weight_ = sums.weight;
  initial_ = 0;
  initial_ = Total(Of(sums));
}

Balance EnergyBook::Of(const AuditSums &sums) const {
  Balance b;
  b.known = on;
  b.sums = sums;
  for (const auto term : kPath) b.sums.*term += earlier_.*term;
  b.gravity = gravity_ + (sums.weight - weight_);
  b.stops = stops_;
  b.changed = changed_;
  b.initial = initial_;
  return b;
}

void EnergyBook::Stop(const AuditSums &before, const AuditSums &after) {
  stops_ += Total(Of(before)) - Total(Of(after));
}

void EnergyBook::NextStage(const AuditSums &before, const AuditSums &after) {
  const Balance end = Of(before);
  const double total = Total(end);
  earlier_ = end.sums;
  gravity_ = end.gravity;
  weight_ = after.weight;
  changed_ += total - Total(Of(after));
}

std::map<std::string, double> EnergyBook::Numbers() const {
  return {{"audit", on ? 1.0 : 0.0}, {"audit_initial", initial_}, {"audit_weight", weight_}};
}

}  // namespace cdem
