#include "cuda/device_tables.cuh"

#include <algorithm>
#include <limits>

namespace cdem {

PetscErrorCode DeviceTables::Create(const Tables &tables, int n_owned_cells) {
  PetscFunctionBeginUser;
  t_ = &tables;
  PetscCall(x_.Upload(tables.x));
  PetscCall(mass_.Upload(tables.mass));
  PetscCall(inverse_mass_.Upload(tables.inverse_mass));
  PetscCall(weight_.Upload(tables.weight));
  if (tables.combined) PetscCall(last_.Allocate(3 * static_cast<std::size_t>(tables.n_owned)));
  PetscCall(block_param_.Upload(tables.block_param));
  PetscCall(joint_param_.Upload(tables.joint_param));
  PetscCall(slots_.Allocate(3 * tables.n_slots));
  for (const ElementTable &t : tables.elements) {
    Elements e;
    e.host = &t;
    PetscCall(e.node.Upload(t.node));
    PetscCall(e.material.Upload(t.material));
    std::vector<std::uint8_t> counted(t.n);
    for (int i = 0; i < t.n; ++i) counted[i] = t.cell[i] < n_owned_cells;
    PetscCall(e.counted.Upload(counted));
    if (t.states > 0) {
      PetscCall(e.state.Allocate(t.n_pad));
      PetscCall(e.value.Allocate(static_cast<std::size_t>(t.states) * t.n_pad));
    }
    if (t.judged)
      PetscCall(e.broken_time.Upload(std::vector<double>(t.n_pad, std::numeric_limits<double>::quiet_NaN())));
    elements_.push_back(std::move(e));
  }
  for (const SpringTable &t : tables.springs) {
    Springs s;
    s.host = &t;
    PetscCall(s.a.Upload(t.a));
    PetscCall(s.b.Upload(t.b));
    PetscCall(s.normal.Upload(t.normal));
    PetscCall(s.kn.Upload(t.kn));
    PetscCall(s.ks.Upload(t.ks));
    PetscCall(s.counted.Upload(t.counted));
    if (!t.state.empty()) {
      PetscCall(s.joint.Upload(t.joint));
      PetscCall(s.area.Upload(t.area));
      PetscCall(s.state.Upload(t.state));
      PetscCall(s.history.Allocate(static_cast<std::size_t>(t.n_state) * t.n_pad));
    }
    springs_.push_back(std::move(s));
  }
  PetscCall(BuildSlotLists());
  PetscCall(CreateAverages());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::Complete(bool audit) {
  PetscFunctionBeginUser;
  const NodeRecords &r = t_->records;
  if (r.n > 0) {
    PetscCall(record_.Upload(r.of_node));
    PetscCall(kind_.Upload(r.kind));
    PetscCall(value_.Upload(r.value));
    PetscCall(table_.Upload(r.table));
    PetscCall(load_start_.Upload(r.load_start));
    PetscCall(load_table_.Upload(r.load_table));
    PetscCall(load_.Upload(r.load));
    PetscCall(watch_.Upload(r.watch));
    PetscCall(quiet_.Upload(r.quiet));
    PetscCall(dashpot_.Upload(r.dashpot));
  }
  if (t_->releases) PetscCall(CreateRelease());
  if (audit) PetscCall(CreateAudit());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::BuildSlotLists() {
  PetscFunctionBeginUser;
  const int n = t_->n_owned, slices = Blocks(n, 32);
  std::vector<int> count(32 * static_cast<std::size_t>(slices), 0);
  // calls f(node, entry) in the order in which the CPU adds
  auto each = [&](auto &&f) {
    for (const ElementTable &t : t_->elements)
      for (int e = 0; e < t.n; ++e)
        for (int a = 0; a < t.corners; ++a) {
          const std::size_t at = static_cast<std::size_t>(a) * t.n_pad + e;
          if (t.node[at] < n) f(t.node[at], static_cast<int>(t.corner_start + at));
        }
    for (const SpringTable &t : t_->springs)
      for (int i = 0; i < t.n; ++i) {
        const int slot = static_cast<int>(t.force_start) + i;
        if (t.a[i] < n) f(t.a[i], slot);
        if (t.b[i] < n) f(t.b[i], ~slot);
      }
  };
  each([&](int node, int) { ++count[node]; });
  std::vector<int> start(slices + 1, 0);
  for (int s = 0; s < slices; ++s) {
    const int width =
        *std::max_element(&count[32 * static_cast<std::size_t>(s)], &count[32 * static_cast<std::size_t>(s)] + 32);
    PetscCheck(start[s] < kNoSlot - 32 * width, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "too many corners on one rank for the GPU; use more ranks");
    start[s + 1] = start[s] + 32 * width;
  }
  std::vector<int> entry(start[slices], kNoSlot);
  std::fill(count.begin(), count.end(), 0);
  each([&](int node, int slot) {
    entry[static_cast<std::size_t>(start[node / 32]) + 32 * count[node]++ + node % 32] = slot;
  });
  PetscCall(list_start_.Upload(start));
  PetscCall(list_entry_.Upload(entry));
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::size_t DeviceTables::Bytes() const {
  std::size_t bytes = 0;
  auto add = [&](const auto &...array) { ((bytes += array.bytes()), ...); };
  add(x_, mass_, inverse_mass_, block_param_, joint_param_, slots_, list_start_, list_entry_, record_, table_,
      load_start_, load_table_, watch_, quiet_, kind_, value_, load_, dashpot_, weight_, last_, partial_, undamped_,
      observed_, node_work_, row_work_, speed_, half_, weight_u_, load_wave_, released_, balance_.u, balance_.residual,
      balance_.now, balance_.share);
  add(averages_.start, averages_.entry, averages_.inverse_volume, averages_.dilatation, averages_.pressure,
      averages_.of_dilatation, averages_.of_pressure, averages_.before);
  for (const Elements &e : elements_)
    add(e.node, e.material, e.layer, e.cell, e.counted, e.state, e.value, e.broken_time, e.work, e.each, e.state_before,
        e.value_before);
  for (const Springs &s : springs_)
    add(s.a, s.b, s.joint, s.cell, s.normal, s.area, s.kn, s.ks, s.history, s.state, s.counted, s.work, s.viscous,
        s.each, s.state_before, s.history_before);
  for (const auto &a : kept_.numbers) add(a);
  for (const auto &a : kept_.states) add(a);
  return bytes;
}

NodeView DeviceTables::Nodes(double *u, double *v, const double *schedule, double *history) const {
  NodeView n;
  n.n_owned = t_->n_owned;
  n.u = u;
  n.v = v;
  n.inverse_mass = inverse_mass_.get();
  n.weight = weight_.get();
  n.last = last_.get();
  n.record = record_.get();
  n.kind = kind_.get();
  n.value = value_.get();
  n.table = table_.get();
  n.load_start = load_start_.get();
  n.load_table = load_table_.get();
  n.load = load_.get();
  n.load_wave = load_wave_.get();
  n.watch = watch_.get();
  n.quiet = quiet_.get();  // NULL without dashpots
  n.dashpot = dashpot_.get();
  n.n_tables = t_->n_tables;
  n.n_watch = t_->n_watch;
  n.schedule = schedule;
  n.history = history;
  return n;
}

ElementView DeviceTables::View(const Elements &e, const double *u, const double *v, double beta, bool early) const {
  const int rates = beta != 0 ? 2 : 1;
  AverageView average;
  if (e.host->averages)
    average = {e.layer.get(),
               t_->layers,
               rates,
               averages_.dilatation.get(),
               averages_.of_dilatation.get() + rates * e.average_start,
               averages_.of_pressure.get() + e.average_start};
  return {e.host->n,
          e.host->n_pad,
          e.node.get(),
          e.material.get(),
          block_param_.get(),
          x_.get(),
          u,
          v,
          beta,
          early,
          slots_.get() + 3 * e.host->corner_start,
          e.counted.get(),
          e.state.get(),
          e.value.get(),
          e.broken_time.get(),
          average};
}

SpringView DeviceTables::View(const Springs &s, const double *u, const double *v, double beta, bool early) const {
  return {s.host->n,
          s.host->n_pad,
          s.a.get(),
          s.b.get(),
          s.joint.get(),
          s.normal.get(),
          s.area.get(),
          s.kn.get(),
          s.ks.get(),
          joint_param_.get(),
          u,
          v,
          beta,
          early,
          s.state.get(),
          s.history.get(),
          slots_.get() + 3 * s.host->force_start,
          s.counted.get()};
}

PetscErrorCode DeviceTables::DownloadHistories(Histories *histories) const {
  PetscFunctionBeginUser;
  histories->elements.resize(elements_.size());
  for (std::size_t g = 0; g < elements_.size(); ++g) {
    PetscCall(elements_[g].state.Download(&histories->elements[g].state));
    PetscCall(elements_[g].value.Download(&histories->elements[g].value));
    PetscCall(elements_[g].broken_time.Download(&histories->elements[g].broken_time));
  }
  histories->springs.resize(springs_.size());
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].state.Download(&histories->springs[g].state));
    PetscCall(springs_[g].history.Download(&histories->springs[g].values));
  }
  PetscCall(last_.Download(&histories->acceleration));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::UploadHistories(const Histories &histories) {
  PetscFunctionBeginUser;
  for (std::size_t g = 0; g < elements_.size(); ++g) {
    PetscCall(elements_[g].state.Overwrite(histories.elements[g].state));
    PetscCall(elements_[g].value.Overwrite(histories.elements[g].value));
    PetscCall(elements_[g].broken_time.Overwrite(histories.elements[g].broken_time));
  }
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].state.Overwrite(histories.springs[g].state));
    PetscCall(springs_[g].history.Overwrite(histories.springs[g].values));
  }
  PetscCall(released_.Overwrite(std::vector<std::uint8_t>(released_.size(), 0)));
  if (audited_) PetscCall(HistoriesAreThoseBefore(nullptr));
  const std::vector<double> &last = histories.acceleration;  // empty: the next step is the first one of its damping
  PetscCall(last_.Overwrite(last.empty() ? std::vector<double>(last_.size(), 0.0) : last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
