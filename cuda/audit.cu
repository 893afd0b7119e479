// The energy audit's memory on the GPU, and the balance at a moment.
#include "cuda/device_tables.cuh"

namespace cdem {

/// Makes one array a copy of another one.
template <class T>
static PetscErrorCode Copy(DeviceArray<T> *to, const DeviceArray<T> &from, cudaStream_t stream) {
  PetscFunctionBeginUser;
  if (to->size() != from.size()) PetscCall(to->Allocate(from.size()));
  if (from.size() > 0) CdemCuda(cudaMemcpyAsync(to->get(), from.get(), from.bytes(), cudaMemcpyDeviceToDevice, stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::HistoriesAreThoseBefore(cudaStream_t stream) {
  PetscFunctionBeginUser;
  for (Elements &e : elements_) {
    if (e.work.size() == 0) continue;
    PetscCall(Copy(&e.state_before, e.state, stream));
    PetscCall(Copy(&e.value_before, e.value, stream));
  }
  for (Springs &s : springs_) {
    if (s.work.size() == 0) continue;
    PetscCall(Copy(&s.state_before, s.state, stream));
    PetscCall(Copy(&s.history_before, s.history, stream));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::CreateAudit() {
  PetscFunctionBeginUser;
  audited_ = true;
  const AuditArrays start = StartAudit(*t_);
  for (std::size_t g = 0; g < elements_.size(); ++g) PetscCall(elements_[g].work.Upload(start.element[g]));
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].work.Upload(start.spring[g]));
    PetscCall(springs_[g].viscous.Upload(start.viscous[g]));
  }
  PetscCall(node_work_.Upload(start.node));
  PetscCall(row_work_.Upload(start.row));
  PetscCall(speed_.Upload(start.speed));
  PetscCall(averages_.before.Upload(start.dilatation));
  PetscCall(load_wave_.Upload(t_->records.load_wave));
  PetscCall(HistoriesAreThoseBefore(nullptr));
  CdemCuda(cudaStreamSynchronize(nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::DownloadAudit(AuditArrays *arrays) const {
  PetscFunctionBeginUser;
  *arrays = AuditArrays();
  if (!audited_) PetscFunctionReturn(PETSC_SUCCESS);
  arrays->element.resize(elements_.size());
  arrays->spring.resize(springs_.size());
  arrays->viscous.resize(springs_.size());
  for (std::size_t g = 0; g < elements_.size(); ++g) PetscCall(elements_[g].work.Download(&arrays->element[g]));
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].work.Download(&arrays->spring[g]));
    PetscCall(springs_[g].viscous.Download(&arrays->viscous[g]));
  }
  PetscCall(node_work_.Download(&arrays->node));
  PetscCall(row_work_.Download(&arrays->row));
  PetscCall(speed_.Download(&arrays->speed));
  PetscCall(averages_.before.Download(&arrays->dilatation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::UploadAudit(const AuditArrays &arrays) {
  PetscFunctionBeginUser;
  if (!audited_) PetscFunctionReturn(PETSC_SUCCESS);
  for (std::size_t g = 0; g < elements_.size(); ++g) PetscCall(elements_[g].work.Overwrite(arrays.element[g]));
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].work.Overwrite(arrays.spring[g]));
    PetscCall(springs_[g].viscous.Overwrite(arrays.viscous[g]));
  }
  PetscCall(node_work_.Overwrite(arrays.node));
  PetscCall(row_work_.Overwrite(arrays.row));
  PetscCall(speed_.Overwrite(arrays.speed));
  PetscCall(averages_.before.Overwrite(arrays.dilatation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// f(array) with every array that the evaluation of an audit changes: histories and works.
template <class F>
void DeviceTables::EachAudited(F &&f) {
  for (Elements &e : elements_) f(e.state), f(e.value), f(e.broken_time), f(e.work);
  for (Springs &s : springs_) f(s.state), f(s.history), f(s.work), f(s.viscous);
  f(node_work_), f(row_work_), f(released_);
}

/// Energies of every element and spring, as an observation has them.
PetscErrorCode DeviceTables::FillEnergies(const NodeView &nodes, const LaunchArgs &launch) {
  PetscFunctionBeginUser;
  for (Elements &e : elements_)
    if (e.each.size() == 0) PetscCall(e.each.Allocate(e.host->n_pad));
  for (Springs &s : springs_)
    if (s.each.size() == 0) PetscCall(s.each.Allocate(s.host->n_pad));
  if (half_.size() == 0) {
    PetscCall(half_.Allocate(t_->n_owned));
    PetscCall(weight_u_.Allocate(t_->n_owned));
  }
  struct Observed unused;
  PetscCall(Observe(nodes, StepArgs(), launch.stream, &unused));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::Audit(const NodeView &nodes, const StepArgs &args, BatchState *batch,
                                   const LaunchArgs &launch, AuditSums *sums) {
  PetscFunctionBeginUser;
  PetscCall(FillEnergies(nodes, launch));
  // The evaluation that ends the step is taken, and taken back: what it dissipates belongs to the step before.
  PetscErrorCode ierr = PETSC_SUCCESS;
  std::size_t numbers = 0, states = 0;
  const auto keep = [&](auto &array) {
    if constexpr (std::is_same_v<std::decay_t<decltype(array)>, DeviceArray<double>>) {
      if (numbers == kept_.numbers.size()) kept_.numbers.emplace_back();
      if (!ierr) ierr = Copy(&kept_.numbers[numbers++], array, launch.stream);
    } else {
      if (states == kept_.states.size()) kept_.states.emplace_back();
      if (!ierr) ierr = Copy(&kept_.states[states++], array, launch.stream);
    }
  };
  EachAudited(keep);
  PetscCall(ierr);
  PetscCall(LaunchDilatation(nodes.u, nodes.v, t_->beta, launch));
  for (const Elements &e : elements_) {
    const ElementView view = View(e, nodes.u, nodes.v, t_->beta);
    VisitBlock(e.host->shape, e.host->form, e.host->law, [&](auto form, auto law) {
      using Form = decltype(form);
      using Law = decltype(law);
      auto kernel = t_->beta != 0 ? ElementKernel<Form, Law, true> : ElementKernel<Form, Law, false>;
      ierr = Launch(kernel, Blocks(e.host->n, launch.block), launch.block, launch, view, batch, false);
    });
    PetscCall(ierr);
    if (e.work.size() > 0) PetscCall(LaunchWork(e, view, args, true, launch));
  }
  PetscCall(LaunchPressure(launch));
  if (t_->releases) {
    PetscCall(LaunchRelease(launch));
    for (const Springs &s : springs_)  // what they store after it
      JointLaws::Visit(s.host->law, [&](auto law) {
        SpringObserveKernel<decltype(law), false><<<Blocks(s.host->n, kBlock), kBlock, 0, launch.stream>>>(
            View(s, nodes.u, nodes.v, 0), partial_.get(), s.each.get());
      });
  }
  PetscCall(LaunchSprings(nodes, args, launch));
  if (t_->n_owned > 0) {
    auto kernel = VisitNodes(*t_, [](auto has) { return NodeBalanceKernel<decltype(has)>; });
    kernel<<<Blocks(t_->n_owned, kBlock), kBlock, 0, launch.stream>>>(nodes, args, Lists(), mass_.get(), Works(),
                                                                      half_.get(), weight_u_.get());
    CdemCuda(cudaGetLastError());
  }

  std::vector<std::vector<Summands>> terms(kAuditTerms);
  const std::size_t owned = static_cast<std::size_t>(t_->n_owned), rows = static_cast<std::size_t>(t_->records.n);
  terms[kKineticSum].push_back({half_.get(), nullptr, owned});
  terms[kWeightSum].push_back({weight_u_.get(), nullptr, owned});
  for (const Elements &e : elements_) {
    const std::size_t n = static_cast<std::size_t>(e.host->n), pad = static_cast<std::size_t>(e.host->n_pad);
    terms[kStrainSum].push_back({e.each.get(), e.counted.get(), n});
    for (int k = 0; k < kElementWorks && e.work.size() > 0; ++k)
      terms[kElementSums0 + k].push_back({e.work.get() + k * pad, e.counted.get(), n});
  }
  for (const Springs &s : springs_) {
    const std::size_t n = static_cast<std::size_t>(s.host->n), pad = static_cast<std::size_t>(s.host->n_pad);
    terms[kSpringSum].push_back({s.each.get(), s.counted.get(), n});
    for (int k = 0; k < kSpringWorks && s.work.size() > 0; ++k)
      terms[kSpringSums0 + k].push_back({s.work.get() + k * pad, s.counted.get(), n});
  }
  for (int k = 0; k < kNodeWorks; ++k) terms[kNodeSums0 + k].push_back({node_work_.get() + k * owned, nullptr, owned});
  for (int k = 0; k < kRowWorks; ++k) terms[kRowSums0 + k].push_back({row_work_.get() + k * rows, nullptr, rows});
  std::vector<double> s;
  PetscCall(sum_.Sum(t_->comm, launch.stream, terms, &s));
  *sums = AuditSums::Of(s);

  numbers = states = 0;
  const auto put_back = [&](auto &array) {
    if constexpr (std::is_same_v<std::decay_t<decltype(array)>, DeviceArray<double>>) {
      if (!ierr) ierr = Copy(&array, kept_.numbers[numbers++], launch.stream);
    } else {
      if (!ierr) ierr = Copy(&array, kept_.states[states++], launch.stream);
    }
  };
  EachAudited(put_back);
  PetscCall(ierr);
  PetscCall(HistoriesAreThoseBefore(launch.stream));
  CdemCuda(cudaStreamSynchronize(launch.stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
