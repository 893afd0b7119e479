// The kernels of one step.
#include "core/events.hpp"
#include "cuda/device_tables.cuh"
#include "cuda/single_kernels.cuh"
#include "forces/elastic_operator.hpp"

namespace cdem {

/// Runs a phase; timed: inside its log event, until the GPU has done it.
template <class Phase>
static PetscErrorCode Run(PetscLogEvent event, const LaunchArgs &launch, Phase &&phase) {
  PetscFunctionBeginUser;
  if (launch.timed) PetscCall(PetscLogEventBegin(event, nullptr, nullptr, nullptr, nullptr));
  PetscCall(phase());
  if (launch.timed) {
    CdemCuda(cudaStreamSynchronize(launch.stream));
    PetscCall(PetscLogEventEnd(event, nullptr, nullptr, nullptr, nullptr));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// [in] law: by which the elements go. [in] first: this launch says which step it is, in batch.
static PetscErrorCode LaunchForces(const ElementTable &t, int law, const ElementView &view, BatchState *batch,
                                   bool first, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscErrorCode ierr = PETSC_SUCCESS;
  VisitBlock(t.shape, t.form, law, [&](auto form, auto block) {
    using Form = decltype(form);
    using Law = decltype(block);
    auto kernel = view.beta != 0 ? ElementKernel<Form, Law, true> : ElementKernel<Form, Law, false>;
    if constexpr (kHasSingle<Form, Law>)
      if (launch.single) kernel = view.beta != 0 ? SingleElementKernel<Form, true> : SingleElementKernel<Form, false>;
    ierr = Launch(kernel, Blocks(t.n, launch.block), launch.block, launch, view, batch, first);
  });
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchElements(const NodeView &nodes, const StepArgs &args, BatchState *batch,
                                            const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  const double beta = t_->beta;
  PetscCall(LaunchDilatation(nodes.u, nodes.v, beta, launch));
  for (const Elements &e : elements_) {
    const bool first = &e == &elements_[0];  // says which step it is
    const ElementView view = View(e, nodes.u, nodes.v, beta, launch.overlap);
    PetscCall(LaunchForces(*e.host, e.host->law, view, batch, first, launch));
  }
  PetscCall(LaunchPressure(launch));
  for (const Elements &e : elements_)
    if (e.work.size() > 0)
      PetscCall(LaunchWork(e, View(e, nodes.u, nodes.v, beta, launch.overlap), args, false, launch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchSprings(const NodeView &nodes, const StepArgs &args, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  const double beta = t_->beta;
  for (const Springs &s : springs_) {
    const SpringView view = View(s, nodes.u, nodes.v, beta, launch.overlap);
    PetscErrorCode ierr = PETSC_SUCCESS;
    JointLaws::Visit(s.host->law, [&](auto law) {
      using Law = decltype(law);
      auto kernel = beta != 0 ? SpringKernel<Law, true> : SpringKernel<Law, false>;
      ierr = Launch(kernel, Blocks(s.host->n, kBlock), kBlock, launch, view);
    });
    PetscCall(ierr);
    if (s.work.size() > 0) PetscCall(LaunchWork(s, view, args, launch));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchElastic(const double *u, const double *param, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscCall(LaunchDilatation(u, nullptr, 0, launch));
  for (const Elements &e : elements_) {
    ElementView view = View(e, u, nullptr, 0, launch.overlap);
    if (param) view.param = param;
    PetscCall(LaunchForces(*e.host, ElasticLaw(*e.host), view, nullptr, false, launch));
  }
  PetscCall(LaunchPressure(launch));
  for (const Springs &s : springs_)
    PetscCall(Launch(SpringKernel<JointElastic, false>, Blocks(s.host->n, kBlock), kBlock, launch,
                     View(s, u, nullptr, 0, launch.overlap)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchStep(const NodeView &nodes, const StepArgs &args, BatchState *batch,
                                        const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscCall(Run(events.elements, launch, [&] { return LaunchElements(nodes, args, batch, launch); }));
  if (t_->releases) PetscCall(LaunchRelease(launch));
  if (!springs_.empty()) PetscCall(Run(events.springs, launch, [&] { return LaunchSprings(nodes, args, launch); }));
  if (t_->n_owned == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Run(events.nodes, launch, [&] { return LaunchNodes(nodes, args, batch, launch); }));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
