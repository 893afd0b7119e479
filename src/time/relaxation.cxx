#include "time/relaxation.hpp"

#include "core/error.hpp"
#include "core/options.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

PetscErrorCode ReadRelaxPlan(Options &options, RelaxPlan *plan) {
  PetscFunctionBeginUser;
  PetscCall(options.Real("relax_ratio", &plan->ratio));
  PetscCall(options.Real("relax_kinetic", &plan->kinetic));
  PetscCall(options.Flag("relax_density_scaling", &plan->scaling));
  PetscCall(options.Int("relax_max_steps", &plan->max_steps));
  PetscCall(options.Int("relax_interval", &plan->interval));
  std::string word = "rayleigh";
  PetscCall(options.Word("relax_damping", &word));
  plan->damping = word == "local"      ? RelaxDamping::kLocal
                  : word == "kinetic"  ? RelaxDamping::kKinetic
                  : word == "combined" ? RelaxDamping::kCombined
                                       : RelaxDamping::kRayleigh;
  for (const auto &[name, value] : {std::pair<const char *, double>{"ratio", plan->ratio}, {"kinetic", plan->kinetic}})
    CdemCheck(value > 0 && value < 1, options.comm(), "-relax_%s is %g; it must be above 0 and below 1", name, value);
  for (const auto &[name, value] :
       {std::pair<const char *, PetscInt>{"max_steps", plan->max_steps}, {"interval", plan->interval}})
    CdemCheck(value >= 1, options.comm(), "-relax_%s is %lld; it must be at least 1", name,
              static_cast<long long>(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The value without its last 12 bits, in which sums differ that were added in another order.
static double Rounded(double value) {
  int exponent;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, 40)), exponent - 40);
}

/// Kinetic energy that counts as a peak, over the energy stored.
static constexpr double kOfStored = 1e-6;

bool Relaxation::Check(const BalanceSums &sums) {
  last_ = {Rounded(sums.kinetic), Rounded(sums.stored), Rounded(sums.unbalanced), Rounded(sums.stiffness),
           Rounded(sums.inertia)};
  memory_.peak = std::max(memory_.peak, last_.kinetic);
  // Rayleigh's quotient of the path since the last check: the frequency of what still moves, mostly the lowest one.
  if (last_.inertia > 0 && last_.stiffness > 0) memory_.alpha = 2 * std::sqrt(Rounded(last_.stiffness / last_.inertia));
  // A body that starts in balance has no peak but rounding: there the energy that it stores is the measure.
  const double reference = std::max(memory_.peak, kOfStored * last_.stored);
  const bool calm = last_.unbalanced <= plan_.ratio && last_.kinetic <= plan_.kinetic * reference;
  memory_.calm = calm ? memory_.calm + 1 : 0;
  return memory_.calm >= 2;  // a kinetic energy that only turns is small for one check
}

bool Relaxation::PassedPeak(double kinetic) {
  const double now = Rounded(kinetic);
  memory_.peak = std::max(memory_.peak, now);
  if (now >= memory_.rising) {
    memory_.rising = now;
    return false;
  }
  memory_.rising = 0;
  return true;
}

}  // namespace cdem
