#include "forces/single_check.hpp"

namespace cdem {

std::string WhyNotSingle(const Tables &tables, bool audit) {
  std::string why;
  for (const ElementTable &t : tables.elements)
    VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
      using Form = decltype(form);
      using Law = decltype(law);
      if (kHasSingle<Form, Law> || !why.empty()) return;
      if (Form::kAverages)
        why = std::string("tetrahedra of form ") + Form::kName + " average over their neighbours";
      else if (Law::kCarriesOffset && std::string(Law::kName) == Elastic::kName)
        why = "elements are under stress from the start, or change their stiffness in a stage";
      else
        why = std::string("the law ") + Law::kName + " is not linear";
    });
  if (why.empty() && audit && tables.beta != 0)
    why = "the energy balance (-monitor_energy) of damping by stiffness is kept in double precision";
  return why;
}

}  // namespace cdem
