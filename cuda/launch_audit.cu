// The kernels of a step that follow its energies.
#include "cuda/device_tables.cuh"

namespace cdem {

PetscErrorCode DeviceTables::LaunchAudited(const Elements &e, const ElementView &view, const StepArgs &args, bool last,
                                           BatchState *batch, bool first, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscErrorCode ierr = PETSC_SUCCESS;
  const ElementAuditView audit = {e.work.get(), speed_.get(), averages_.before.get(), args.dt_old, args.dt, last};
  VisitBlock(e.host->shape, e.host->form, e.host->law, [&](auto form, auto law) {
    ierr = Launch(AuditedElementKernel<decltype(form), decltype(law)>, Blocks(e.host->n, launch.block), launch.block,
                  launch, view, audit, batch, first);
  });
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::LaunchAudited(const Springs &s, const SpringView &view, const StepArgs &args,
                                           const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  PetscErrorCode ierr = PETSC_SUCCESS;
  const SpringAuditView audit = {s.work.get(), s.viscous.get(), args.dt_old};
  JointLaws::Visit(s.host->law, [&](auto law) {
    using Law = decltype(law);
    auto kernel = t_->beta != 0 ? AuditedSpringKernel<Law, true> : AuditedSpringKernel<Law, false>;
    ierr = Launch(kernel, Blocks(s.host->n, kBlock), kBlock, launch, view, audit);
  });
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
