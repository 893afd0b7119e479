#include "forces/host_element_loop.hpp"

#include <limits>

namespace cdem {

static void OfTable(const ElementPass &pass, std::size_t g, std::vector<ElementHistories> &history) {
  const ElementTable &t = pass.tables.elements[g];
  switch (t.shape) {
    case Shape::kTet:
      TetElements(pass, t, &history[g]);
      break;
    case Shape::kWedge:
      WedgeElements(pass, t, &history[g]);
      break;
    case Shape::kHex:
      HexElements(pass, t, &history[g]);
      break;
  }
}

static void Elements(ElementPass pass, std::vector<ElementHistories> &history) {
  static thread_local Averages averages;  // keeps its memory from step to step
  const Tables &tables = pass.tables;
  if (tables.layers > 0) {
    pass.averages = &averages;
    PetscCallAbort(tables.comm, AverageDilatation(tables, pass.u, pass.v, pass.beta, &averages));
    pass.averages->before = pass.audit ? &pass.audit->arrays->dilatation : nullptr;
    for (std::size_t g = 0; g < tables.elements.size(); ++g)
      if (tables.elements[g].averages) OfTable(pass, g, history);
    PetscCallAbort(tables.comm, AveragePressure(tables, &averages));
  }
  for (std::size_t g = 0; g < tables.elements.size(); ++g)
    if (tables.elements[g].averages)
      AddAveraged(tables, g, averages, pass.f);
    else
      OfTable(pass, g, history);
  if (pass.audit && tables.layers > 0) pass.audit->arrays->dilatation = averages.dilatation;
}

void HostElements(const Tables &tables, const double *u, const double *v, double beta, double time,
                  std::vector<ElementHistories> &history, double *f, const AuditPass *audit, bool single) {
  Elements({tables, u, v, beta, time, f, 0, nullptr, nullptr, audit, single}, history);
}

void HostElementsObserve(const Tables &tables, int n_owned_cells, const double *u, const double *v, double beta,
                         const std::vector<ElementHistories> &history, double *f, ElementResults *results) {
  auto &unchanged = const_cast<std::vector<ElementHistories> &>(history);  // an observing pass only reads
  Elements({tables, u, v, beta, 0, f, n_owned_cells, results, nullptr, nullptr}, unchanged);
}

std::vector<ElementHistories> StartElements(const Tables &tables) {
  std::vector<ElementHistories> history(tables.elements.size());
  for (std::size_t g = 0; g < history.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    if (t.states == 0) continue;
    history[g].state.assign(t.n_pad, 0);
    history[g].value.assign(static_cast<std::size_t>(t.states) * t.n_pad, 0.0);
    if (t.judged) history[g].broken_time.assign(t.n_pad, std::numeric_limits<double>::quiet_NaN());
  }
  return history;
}

}  // namespace cdem
