// The kernels that follow the energies of a step, behind its own.
#include "cuda/device_tables.cuh"

namespace cdem {

PetscErrorCode DeviceTables::LaunchWork(const Elements &e, const ElementView &view, const StepArgs &args, bool last,
                                        const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscErrorCode ierr = PETSC_SUCCESS;
  const ElementAuditView audit = {e.work.get(), e.state_before.get(),   e.value_before.get(), e.host->states,
                                  speed_.get(), averages_.before.get(), args.dt_old,          args.dt,
                                  last};
  VisitBlock(e.host->shape, e.host->form, e.host->law, [&](auto form, auto law) {
    ierr = Launch(ElementWorkKernel<decltype(form), decltype(law)>, Blocks(e.host->n, launch.block), launch.block,
                  launch, view, audit);
  });
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchWork(const Springs &s, const SpringView &view, const StepArgs &args,
                                        const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscErrorCode ierr = PETSC_SUCCESS;
  const SpringAuditView audit = {s.work.get(), s.state_before.get(), s.history_before.get(), s.viscous.get(),
                                 args.dt_old};
  JointLaws::Visit(s.host->law, [&](auto law) {
    using Law = decltype(law);
    auto kernel = t_->beta != 0 ? SpringWorkKernel<Law, true> : SpringWorkKernel<Law, false>;
    ierr = Launch(kernel, Blocks(s.host->n, kBlock), kBlock, launch, view, audit);
  });
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
