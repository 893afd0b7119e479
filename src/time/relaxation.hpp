// Dynamic relaxation: what a run to equilibrium is asked for, and the controller that damps it and says when it is there.
#pragma once
#include "core/petsc.hpp"

#include <limits>

namespace cdem {

class Options;

/// How a run is brought to rest.
enum class RelaxDamping { kLocal, kKinetic, kRayleigh, kCombined };

struct RelaxPlan {
  RelaxDamping damping = RelaxDamping::kRayleigh;
  double ratio = 1e-7;     ///< unbalanced force ratio at which it is converged
  double kinetic = 1e-12;  ///< and the kinetic energy, over its peak
  bool scaling = true;     ///< of the density, so that every node runs at one step
  PetscInt max_steps = 1000000, interval = 100;
};

/// Reads -relax_*.
PetscErrorCode ReadRelaxPlan(Options &options, RelaxPlan *plan);

/// What a check sees, summed over the ranks.
struct BalanceSums {
  double kinetic = 0;     ///< J
  double stored = 0;      ///< J, in elements and springs
  double unbalanced = 0;  ///< ratio of forces
  double stiffness = 0;   ///< du . K du since the last check [J]
  double inertia = 0;     ///< du . M du [kg m^2]
};

/// What a relaxation remembers from one check to the next.
struct RelaxMemory {
  double peak = 0, rising = 0;  ///< kinetic energy: the largest so far; the last one on the way to the next peak [J]
  double alpha = 0;             ///< 1/s
  int calm = 0;                 ///< checks in a row that found the body in balance
};

/// Watches the checks of one relaxation. Steers by sums rounded to 40 bits, so that CPU and GPU see the same.
class Relaxation {
 public:
  explicit Relaxation(const RelaxPlan &plan) : plan_(plan) {}
  const RelaxPlan &plan() const { return plan_; }

  /// One check; true when the body is in balance.
  bool Check(const BalanceSums &sums);
  /// Whether the kinetic energy has just passed a peak (kinetic damping looks at it between checks too). [J]
  bool PassedPeak(double kinetic);
  /// Damping by mass [1/s] that is critical for the lowest frequency seen; 0 before anything is known.
  double Alpha() const { return memory_.alpha; }
  const BalanceSums &last() const { return last_; }
  double peak() const { return memory_.peak; }  ///< of the kinetic energy so far [J]
  const RelaxMemory &memory() const { return memory_; }
  /// Goes on from what an earlier run remembered.
  void Recall(const RelaxMemory &memory) { memory_ = memory; }

 private:
  RelaxPlan plan_;
  BalanceSums last_;
  RelaxMemory memory_;
};

}  // namespace cdem
