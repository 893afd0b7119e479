// What a run says of its critical step.
#pragma once
#include "forces/sharp_step.hpp"

#include <string>

namespace cdem {

/// What the header says of it, after "dt ... s". [in] dt [s]; sharp: NULL where only the bound was asked for.
std::string CriticalStepText(double dt, const StepBound &bound, const SharpStep *sharp);
/// Why a given step dt [s] is too large.
std::string StepAboveText(double dt, const StepBound &bound, const SharpStep *sharp);
/// Why the bound serves although the sharp step was asked for.
std::string NotSharpText(const SharpStep &sharp);

}  // namespace cdem
