// The energy balance of a run: what its stages have dissipated and been given, and what is missing in the end.
#pragma once
#include "forces/audit.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cdem {

/// All terms of the balance [J] at one moment, over the whole run so far.
struct Balance {
  bool known = false;  ///< the audit is on
  AuditSums sums;      ///< of all stages
  double gravity = 0;  ///< work of the weight
  double stops = 0;    ///< kinetic energy taken by relaxations that set velocities to 0
  double changed = 0;  ///< energy that left between stages: with removed regions, changed laws, scaled masses
  double initial = 0;  ///< stored at the beginning

  double Work() const { return gravity + sums.loads + sums.wave + sums.motion; }
  double Stored() const { return sums.kinetic + sums.strain + sums.spring; }
  double Dissipated() const;
  /// What the balance lacks: initial energy and work, less what is stored, dissipated or has left.
  double Missing() const { return initial + Work() - Stored() - Dissipated() - changed; }
  /// The work done, to which errors are related: sizes of all works and the initial energy, or what became of them.
  double Scale() const;
  double Error() const;
};

/// One term for monitor and summary.
struct BalanceTerm {
  const char *name;
  double (*value)(const Balance &balance);
};
/// The dissipations and works, in the order of the columns; the error is the last one.
extern const std::vector<BalanceTerm> kBalanceTerms;

/// Follows the balance through stages and restarts, from the sums of the present stage's backend.
class EnergyBook {
 public:
  bool on = false;

  /// The run, or its continuation without a balance of before, begins.
  void Begin(const AuditSums &sums);
  Balance Of(const AuditSums &sums) const;
  /// Velocities were set to 0 between these.
  void Stop(const AuditSums &before, const AuditSums &after);
  /// The backend of the stage that ended gave before, that of the coming one gives after.
  void NextStage(const AuditSums &before, const AuditSums &after);
  /// What a checkpoint must hold besides the backend's arrays, and back.
  std::map<std::string, double> Numbers() const;
  void Resume(double initial, double weight_at_start) { initial_ = initial, weight_ = weight_at_start; }

 private:
  double Total(const Balance &b) const { return b.Stored() + b.Dissipated() + b.changed - b.Work(); }
  AuditSums earlier_;                // of stages that have ended
  double gravity_ = 0, weight_ = 0;  // work of the weight in them; weight times u where the stage began
  double stops_ = 0, changed_ = 0, initial_ = 0;
};

}  // namespace cdem
