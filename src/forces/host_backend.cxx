#include "core/error.hpp"
#include "core/events.hpp"
#include "forces/assembled.hpp"
#include "forces/host_audit.hpp"
#include "forces/host_stencil.hpp"
#include "forces/observe.hpp"
#include "forces/release.hpp"

#include <algorithm>

namespace cdem {

NodeView HostView(const Tables &t, double *u, double *v, const double *schedule, double *history) {
  NodeView n;
  n.n_owned = t.n_owned;
  n.u = u;
  n.v = v;
  n.inverse_mass = t.inverse_mass.data();
  n.weight = t.weight.empty() ? nullptr : t.weight.data();
  n.n_tables = t.n_tables;
  n.n_watch = t.n_watch;
  n.schedule = schedule;
  n.history = history;
  if (t.records.n > 0) {
    n.record = t.records.of_node.data();
    n.kind = t.records.kind.data();
    n.value = t.records.value.data();
    n.table = t.records.table.data();
    n.load_start = t.records.load_start.data();
    n.load_table = t.records.load_table.data();
    n.load = t.records.load.data();
    n.load_wave = t.records.load_wave.data();
    n.watch = t.records.watch.data();
    if (!t.records.quiet.empty()) {
      n.quiet = t.records.quiet.data();
      n.dashpot = t.records.dashpot.data();
    }
  }
  return n;
}

PetscErrorCode ObserveOnHost(const Tables &tables, int n_owned_cells, const double *u, const double *v,
                             const Histories &history, const StepArgs &next, const double *schedule,
                             ElementResults *elements, SpringResults *springs, std::vector<double> *v_now,
                             Observed *observed, std::vector<double> *residual) {
  PetscFunctionBeginUser;
  std::vector<double> f(3 * static_cast<std::size_t>(tables.n_local), 0.0), damped;
  HostElementsObserve(tables, n_owned_cells, u, v, 0, history.elements, f.data(), elements);
  HostSpringsObserve(tables, u, v, 0, history.springs, f.data(), springs);
  if (tables.beta != 0) {
    damped.assign(f.size(), 0.0);
    ElementResults unused_elements;
    SpringResults unused;
    HostElementsObserve(tables, 0, u, v, tables.beta, history.elements, damped.data(), &unused_elements);
    HostSpringsObserve(tables, u, v, tables.beta, history.springs, damped.data(), &unused);
  }
  const double *f_damped = damped.empty() ? f.data() : damped.data();
  const NodeView view = HostView(tables, const_cast<double *>(u), const_cast<double *>(v), schedule, nullptr);
  for (std::vector<double> *result : {v_now, residual})
    if (result) result->resize(3 * static_cast<std::size_t>(tables.n_owned));
  Observed sum;
  const auto observe = VisitNodes(tables, [](auto has) { return &ObserveNode<has.kRecords, has.kQuiet, has.kDamped>; });
  for (int i = 0; i < tables.n_owned; ++i) {
    double now[3];
    const double *fi = &f[3 * static_cast<std::size_t>(i)], *fd = f_damped + 3 * static_cast<std::size_t>(i);
    const NodeSums s = observe(view, next, i, tables.mass[i], fi, fd, now);
    if (residual) std::copy_n(s.force, 3, &(*residual)[3 * static_cast<std::size_t>(i)]);
    if (v_now) std::copy_n(now, 3, &(*v_now)[3 * static_cast<std::size_t>(i)]);
    sum.kinetic += s.kinetic;
    sum.form += s.form;
    sum.load_u += s.load_u;
    for (int k = 0; k < 3; ++k) sum.momentum[k] += s.momentum[k];
    sum.residual_sum += s.residual;
    sum.residual_count += s.free;
    sum.v_max2 = std::max(sum.v_max2, s.v2);
    sum.u_max2 = std::max(sum.u_max2, s.u2);
  }
  sum.strain = elements->energy;
  sum.spring = springs->energy;
  sum.force_sum = elements->force_sum + springs->force_sum;
  sum.force_count = elements->force_count + springs->force_count;
  sum.broken = springs->broken;
  sum.springs = springs->count;
  sum.broken_elements = elements->broken;
  if (observed) *observed = sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

namespace {

class HostBackend final : public Backend {
 public:
  HostBackend(const Tables &tables, int n_owned_cells, const BackendChoice &choice)
      : t_(tables), n_owned_cells_(n_owned_cells), single_(choice.single),
        u_(3 * static_cast<std::size_t>(tables.n_local), 0.0), v_(u_), f_(u_) {
    history_.elements = StartElements(tables);
    history_.springs = StartSprings(tables);
    StartAccelerations();
    if (choice.audit) audit_ = StartAudit(tables);
  }

  std::string Name() const override {
    const char *set = kLanes == 8 ? "AVX-512" : kLanes == 4 ? "AVX" : "SSE2";
    return "cpu, " + std::to_string(kLanes) + " lanes (" + set + ")";
  }
  Way WayOfStep() const override { return way_; }
  /// [in] way: its name, or "auto". Errors: a way that the scene cannot go.
  PetscErrorCode ChooseWay(const std::string &way) {
    PetscFunctionBeginUser;
    if (way == "reference") PetscFunctionReturn(PETSC_SUCCESS);
    if (way == "assembled") {
      PetscCall(CheckAssembled(t_, !audit_.Empty()));
      assembled_ = std::make_unique<AssembledWay>();
      PetscCall(assembled_->Create(t_, u_.data(), f_.data()));
      way_ = assembled_->way();
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    auto stencil = std::make_unique<HostStencil>();
    const std::string why =
        audit_.Empty() ? stencil->Create(t_, way != "auto") : "the energy balance is kept (-monitor_energy)";
    CdemCheck(way == "auto" || why.empty(), t_.comm, "-central_way stencil: this scene cannot go that way: %s",
              why.c_str());
    if (why.empty()) {
      way_ = {"stencil", stencil->Text()};
      stencil_ = std::move(stencil);
    } else {
      way_.text += " (not stencil: " + why + ")";
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  std::size_t Bytes() const override {
    std::size_t bytes =
        (stencil_ ? stencil_->Bytes() : 0) + (assembled_ ? assembled_->Bytes() : 0) +
        8 * (3 * u_.size() + history_.acceleration.size() + t_.weight.size() + t_.x.size() + 2 * t_.mass.size());
    for (const ElementTable &e : t_.elements) bytes += 4 * (e.node.size() + e.material.size());
    for (const SpringTable &s : t_.springs) bytes += static_cast<std::size_t>(s.n_pad) * (4 * 3 + 8 * 6);
    for (const SpringHistory &h : history_.springs) bytes += h.state.size() + 8 * h.values.size();
    for (const ElementHistories &h : history_.elements)
      bytes += h.state.size() + 8 * (h.value.size() + h.broken_time.size());
    return bytes;
  }

  PetscErrorCode CreateVecs(Vec *u, Vec *v) override {
    PetscFunctionBeginUser;
    const PetscInt n = 3 * static_cast<PetscInt>(t_.n_owned);
    PetscCall(VecCreateMPIWithArray(t_.comm, 3, n, PETSC_DECIDE, u_.data(), u));
    PetscCall(VecCreateMPIWithArray(t_.comm, 3, n, PETSC_DECIDE, v_.data(), v));
    vec_u_ = *u, vec_v_ = *v;
    if (t_.halo) {
      PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &unit_));
      PetscCallMPI(MPI_Type_commit(&unit_));
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }

  PetscErrorCode Advance(const Batch &batch, Failure *failure) override {
    PetscFunctionBeginUser;
    *failure = Failure();
    NodeView view = HostView(t_, u_.data(), v_.data(), batch.schedule, batch.history);
    if (t_.combined) view.last = history_.acceleration.data();
    for (int step = 0; step < batch.n; ++step) {
      const StepArgs &args = step == 0 ? batch.first : batch.rest;
      if (stencil_ && args == batch.rest) {
        PetscCall(Timed(events.nodes, &nodes_, [&] {
          stencil_->Run(view, args, step, batch.n - step, failure);
          return PETSC_SUCCESS;
        }));
        break;
      }
      const AuditPass followed{&audit_, args.dt_old, args.dt, false}, *audit = audit_.Empty() ? nullptr : &followed;
      if (!t_.halo && failure->step >= 0) break;  // several ranks go on together, and tell at the end
      PetscCall(Timed(events.halo, &halo_, [&] { return Halo(); }));
      PetscCall(Timed(events.elements, &elements_, [&]() -> PetscErrorCode {
        if (assembled_) return assembled_->Forces(v_.data());
        std::fill(f_.begin(), f_.end(), 0.0);
        const double time = StepEnd(batch.base, batch.offset, step, batch.rest.dt);
        HostElements(t_, u_.data(), v_.data(), t_.beta, time, history_.elements, f_.data(), audit, single_);
        return PETSC_SUCCESS;
      }));
      if (t_.releases) PetscCall(ReleaseSprings(t_, history_.elements, &released_, &history_.springs));
      if (!t_.springs.empty() && !assembled_)
        PetscCall(Timed(events.springs, &springs_, [&] {
          HostSprings(t_, u_.data(), v_.data(), t_.beta, history_.springs, f_.data(), audit);
          return PETSC_SUCCESS;
        }));
      PetscCall(Timed(events.nodes, &nodes_, [&] {
        if (!audit_.speed.empty()) audit_.speed = v_;
        if (audit) HostNodesWork(t_, view, args, step, f_.data(), &audit_);
        const int bad = HostNodes(t_, view, args, step, f_.data());
        if (bad >= 0 && failure->step < 0) *failure = Failure{step, bad};
        return PETSC_SUCCESS;
      }));
    }
    PetscCall(TellVecs());
    PetscFunctionReturn(PETSC_SUCCESS);
  }

  PetscErrorCode Observe(const StepArgs &next, const double *schedule, Observed *observed) override {
    PetscFunctionBeginUser;
    PetscCall(Halo());
    ElementResults elements;
    SpringResults springs;
    PetscCall(ObserveOnHost(t_, n_owned_cells_, u_.data(), v_.data(), history_, next, schedule, &elements, &springs,
                            nullptr, observed));
    PetscFunctionReturn(PETSC_SUCCESS);
  }

  PetscErrorCode LookAtBalance(const StepArgs &next, const double *schedule, Observed *observed,
                               BalanceTerms *terms) override {
    PetscFunctionBeginUser;
    PetscCall(Halo());
    ElementResults elements;
    SpringResults springs;
    std::vector<double> v_now;
    PetscCall(ObserveOnHost(t_, n_owned_cells_, u_.data(), v_.data(), history_, next, schedule, &elements, &springs,
                            &v_now, observed, &balance_.now));
    PetscCall(BalanceOnHost(t_, u_.data(), v_now.data(), balance_, terms));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode KeepLook() override {
    balance_.u.assign(u_.begin(), u_.begin() + 3 * static_cast<std::ptrdiff_t>(t_.n_owned));
    balance_.residual = balance_.now;
    return PETSC_SUCCESS;
  }
  PetscErrorCode DownloadBalance(const BalanceMemory **memory) override {
    *memory = &balance_;
    return PETSC_SUCCESS;
  }
  PetscErrorCode UploadBalance(const BalanceMemory &memory) override {
    balance_ = memory;
    return PETSC_SUCCESS;
  }
  PetscErrorCode Kinetic(double *energy) override { return KineticOnHost(t_, v_.data(), energy); }

  PetscErrorCode Audit(const StepArgs &next, const double *schedule, AuditSums *sums) override {
    PetscFunctionBeginUser;
    PetscCheck(!audit_.Empty(), PETSC_COMM_SELF, PETSC_ERR_ORDER, "the energy audit is off");
    PetscCall(Halo());
    NodeView view = HostView(t_, u_.data(), v_.data(), schedule, nullptr);
    if (t_.combined) view.last = history_.acceleration.data();
    PetscCall(AuditOnHost(t_, n_owned_cells_, view, history_, audit_, next, sums));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode DownloadAudit(const AuditArrays **arrays) override {
    *arrays = &audit_;
    return PETSC_SUCCESS;
  }
  PetscErrorCode UploadAudit(const AuditArrays &arrays) override {
    audit_ = arrays;
    return PETSC_SUCCESS;
  }

  PetscErrorCode Download(const double **u, const double **v, const Histories **history) override {
    PetscFunctionBeginUser;
    PetscCall(Halo());
    *u = u_.data();
    *v = v_.data();
    *history = &history_;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Upload(const double *u, const double *v, const Histories &history) override {
    PetscFunctionBeginUser;
    std::copy_n(u, 3 * static_cast<std::size_t>(t_.n_owned), u_.data());
    std::copy_n(v, 3 * static_cast<std::size_t>(t_.n_owned), v_.data());
    history_ = history;
    if (history_.acceleration.empty()) StartAccelerations();
    PetscCall(TellVecs());
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Synchronize() override { return PETSC_SUCCESS; }
  std::vector<std::pair<std::string, double>> Phases() const override {
    return {{"elements", elements_}, {"springs", springs_}, {"nodes", nodes_}, {"halo", halo_}};
  }
  ~HostBackend() override {
    if (unit_ != MPI_DATATYPE_NULL) MPI_Type_free(&unit_);
  }

 private:
  void StartAccelerations() {
    history_.acceleration.assign(t_.combined ? 3 * static_cast<std::size_t>(t_.n_owned) : 0, 0.0);
  }
  /// PETSc must know that the values of the Vecs changed.
  PetscErrorCode TellVecs() {
    PetscFunctionBeginUser;
    for (Vec vec : {vec_u_, vec_v_}) {
      PetscScalar *values;
      PetscCall(VecGetArray(vec, &values));
      PetscCall(VecRestoreArray(vec, &values));
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscErrorCode Halo() {
    PetscFunctionBeginUser;
    if (!t_.halo) PetscFunctionReturn(PETSC_SUCCESS);
    const std::size_t ghosts = 3 * static_cast<std::size_t>(t_.n_owned);
    PetscCall(PetscSFBcastBegin(t_.halo, unit_, u_.data(), u_.data() + ghosts, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(t_.halo, unit_, u_.data(), u_.data() + ghosts, MPI_REPLACE));
    if (t_.beta != 0 || !audit_.Empty()) {
      PetscCall(PetscSFBcastBegin(t_.halo, unit_, v_.data(), v_.data() + ghosts, MPI_REPLACE));
      PetscCall(PetscSFBcastEnd(t_.halo, unit_, v_.data(), v_.data() + ghosts, MPI_REPLACE));
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /// Runs a phase inside its log event and adds its wall time.
  template <class Phase>
  PetscErrorCode Timed(PetscLogEvent event, double *seconds, Phase &&phase) {
    PetscFunctionBeginUser;
    const double begin = MPI_Wtime();
    PetscCall(PetscLogEventBegin(event, nullptr, nullptr, nullptr, nullptr));
    PetscCall(phase());
    PetscCall(PetscLogEventEnd(event, nullptr, nullptr, nullptr, nullptr));
    *seconds += MPI_Wtime() - begin;
    PetscFunctionReturn(PETSC_SUCCESS);
  }

  const Tables &t_;
  int n_owned_cells_;
  bool single_;
  std::vector<double> u_, v_, f_;
  Histories history_;
  std::unique_ptr<HostStencil> stencil_;     // where the scene goes that way
  std::unique_ptr<AssembledWay> assembled_;  // where the user asks for it
  Way way_;
  AuditArrays audit_;                      // empty while the audit is off
  BalanceMemory balance_;                  // of relaxations
  std::vector<std::uint8_t> released_;     // of cells, where breaking elements release their interfaces
  Vec vec_u_ = nullptr, vec_v_ = nullptr;  // borrowed
  MPI_Datatype unit_ = MPI_DATATYPE_NULL;
  double elements_ = 0, springs_ = 0, nodes_ = 0, halo_ = 0;  // wall [s]
};

}  // namespace

PetscErrorCode CreateHostBackend(const Tables &tables, int n_owned_cells, const BackendChoice &choice,
                                 std::unique_ptr<Backend> *backend) {
  PetscFunctionBeginUser;
  auto made = std::make_unique<HostBackend>(tables, n_owned_cells, choice);
  PetscCall(made->ChooseWay(choice.way));
  *backend = std::move(made);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
