// Which elements can be computed in single precision.
#pragma once
#include "forces/tables.hpp"
#include "physics/elements.hpp"

#include <string>

namespace cdem {

/// Forces that are linear in the displacements and remember nothing, of an element's own corners alone: they hold to the
/// rounding of single precision, while the history of a law would gather its errors.
template <class Form, class Law>
inline constexpr bool kHasSingle = Law::kLinear && !Form::kAverages;

/// Why elements of these tables cannot be computed in single precision; empty: they can. [in] audit: energies are
/// followed from step to step.
std::string WhyNotSingle(const Tables &tables, bool audit);

}  // namespace cdem
