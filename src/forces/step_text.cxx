#include "forces/step_text.hpp"

#include <cstdio>

namespace cdem {

std::string CriticalStepText(double dt, const StepBound &bound, const SharpStep *sharp) {
  char text[200];
  if (sharp && sharp->converged)
    std::snprintf(text, sizeof text, ", %.3g of the critical step %.6g s (sharp, %d iterations; rigorous bound %.6g s)",
                  dt / sharp->dt, sharp->dt, sharp->iterations, bound.dt);
  else
    std::snprintf(text, sizeof text, ", %.3g of the critical step %.6g s (a rigorous bound)", dt / bound.dt, bound.dt);
  return text;
}

std::string StepAboveText(double dt, const StepBound &bound, const SharpStep *sharp) {
  char text[300];
  if (sharp && sharp->converged)
    std::snprintf(text, sizeof text,
                  "-ts_dt %g is above the critical step %g s: the limit itself, less 1 %% at the most, and not only a "
                  "bound",
                  dt, sharp->dt);
  else
    std::snprintf(
        text, sizeof text,
        "-ts_dt %g is above the critical step %g s. That number is a rigorous bound, up to 1.6 times below the "
        "exact limit (more where tetrahedra are flat): a larger step may still be stable%s",
        dt, bound.dt, sharp ? "" : " (-ts_central_limit sharp tells)");
  return text;
}

std::string NotSharpText(const SharpStep &sharp) {
  if (sharp.iterations == 0)
    return "no component that is free to move has stiffness: the critical step is the bound of the elements";
  char text[200];
  std::snprintf(text, sizeof text,
                "the sharp critical step was not found in %d iterations (residual %.2g of the Ritz value): the bound "
                "is taken",
                sharp.iterations, sharp.theta > 0 ? sharp.residual / sharp.theta : 1);
  return text;
}

}  // namespace cdem
