#include "cuda/device_tables.cuh"

#include <algorithm>

namespace cdem {

PetscErrorCode DeviceTables::Create(const Tables &tables, int n_owned_cells) {
  PetscFunctionBeginUser;
  t_ = &tables;
  PetscCall(x_.Upload(tables.x));
  PetscCall(mass_.Upload(tables.mass));
  PetscCall(inverse_mass_.Upload(tables.inverse_mass));
  PetscCall(block_param_.Upload(tables.block_param));
  PetscCall(joint_param_.Upload(tables.joint_param));
  PetscCall(slots_.Allocate(3 * tables.n_slots));
  for (const ElementTable &t : tables.elements) {
    Elements e{&t, {}, {}, {}};
    PetscCall(e.node.Upload(t.node));
    PetscCall(e.material.Upload(t.material));
    std::vector<std::uint8_t> counted(t.n);
    for (int i = 0; i < t.n; ++i) counted[i] = t.cell[i] < n_owned_cells;
    PetscCall(e.counted.Upload(counted));
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
      PetscCall(s.slip.Allocate(3 * static_cast<std::size_t>(t.n_pad)));
    }
    springs_.push_back(std::move(s));
  }
  const NodeRecords &r = tables.records;
  if (r.n > 0) {
    PetscCall(record_.Upload(r.of_node));
    PetscCall(kind_.Upload(r.kind));
    PetscCall(value_.Upload(r.value));
    PetscCall(table_.Upload(r.table));
    PetscCall(load_start_.Upload(r.load_start));
    PetscCall(load_table_.Upload(r.load_table));
    PetscCall(load_.Upload(r.load));
    PetscCall(watch_.Upload(r.watch));
  }
  PetscCall(BuildSlotLists());
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
      load_start_, load_table_, watch_, kind_, value_, load_, partial_, undamped_);
  for (const Elements &e : elements_) add(e.node, e.material, e.counted);
  for (const Springs &s : springs_) add(s.a, s.b, s.joint, s.normal, s.area, s.kn, s.ks, s.slip, s.state, s.counted);
  return bytes;
}

NodeView DeviceTables::Nodes(double *u, double *v, const double *schedule, double *history) const {
  NodeView n;
  n.n_owned = t_->n_owned;
  n.u = u;
  n.v = v;
  n.inverse_mass = inverse_mass_.get();
  n.record = record_.get();
  n.kind = kind_.get();
  n.value = value_.get();
  n.table = table_.get();
  n.load_start = load_start_.get();
  n.load_table = load_table_.get();
  n.load = load_.get();
  n.watch = watch_.get();
  n.n_tables = t_->n_tables;
  n.n_watch = t_->n_watch;
  n.schedule = schedule;
  n.history = history;
  return n;
}

ElementView DeviceTables::View(const Elements &e, const double *u, const double *v, double beta) const {
  return {e.host->n,
          e.host->n_pad,
          e.node.get(),
          e.material.get(),
          block_param_.get(),
          x_.get(),
          u,
          v,
          beta,
          slots_.get() + 3 * e.host->corner_start,
          e.counted.get()};
}

SpringView DeviceTables::View(const Springs &s, const double *u, const double *v, double beta) const {
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
          s.state.get(),
          s.slip.get(),
          slots_.get() + 3 * s.host->force_start,
          s.counted.get()};
}

void DeviceTables::LaunchStep(const NodeView &nodes, const StepArgs &args, BatchState *batch, int block,
                              cudaStream_t stream) {
  BatchState *first = batch;  // the first kernel counts the step
  const double beta = t_->beta;
  for (const Elements &e : elements_)
    VisitElement(e.host->shape, [&](auto form) {
      BlockLaws::Visit(e.host->law, [&](auto law) {
        using Form = decltype(form);
        using Law = decltype(law);
        const ElementView view = View(e, nodes.u, nodes.v, beta);
        const int blocks = Blocks(e.host->n, block);
        if (beta != 0)
          ElementKernel<Form, Law, true><<<blocks, block, 0, stream>>>(view, first);
        else
          ElementKernel<Form, Law, false><<<blocks, block, 0, stream>>>(view, first);
        first = nullptr;
      });
    });
  for (const Springs &s : springs_)
    JointLaws::Visit(s.host->law, [&](auto law) {
      using Law = decltype(law);
      const SpringView view = View(s, nodes.u, nodes.v, beta);
      const int blocks = Blocks(s.host->n, kBlock);
      if (beta != 0)
        SpringKernel<Law, true><<<blocks, kBlock, 0, stream>>>(view);
      else
        SpringKernel<Law, false><<<blocks, kBlock, 0, stream>>>(view);
    });
  const int blocks = Blocks(t_->n_owned, kBlock);
  if (t_->n_owned == 0) return;
  if (t_->records.n > 0)
    NodeKernel<true><<<blocks, kBlock, 0, stream>>>(nodes, args, Lists(), batch);
  else
    NodeKernel<false><<<blocks, kBlock, 0, stream>>>(nodes, args, Lists(), batch);
}

PetscErrorCode DeviceTables::AddPartial(int blocks, int columns, double *sums, int maxima) const {
  PetscFunctionBeginUser;
  std::vector<double> rows(static_cast<std::size_t>(blocks) * columns);
  CdemCuda(cudaGetLastError());
  CdemCuda(cudaMemcpy(rows.data(), partial_.get(), rows.size() * sizeof(double), cudaMemcpyDeviceToHost));
  for (int b = 0; b < blocks; ++b)
    for (int k = 0; k < columns; ++k) {
      const double value = rows[static_cast<std::size_t>(b) * columns + k];
      sums[k] = k < columns - maxima ? sums[k] + value : std::max(sums[k], value);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::Observe(const NodeView &nodes, const StepArgs &args, cudaStream_t stream,
                                     Observed *observed) {
  PetscFunctionBeginUser;
  if (partial_.size() == 0) {
    int most = Blocks(t_->n_owned, kBlock) * kNodeSums;
    for (const Elements &e : elements_) most = std::max(most, Blocks(e.host->n, kBlock) * kElementSums);
    for (const Springs &s : springs_) most = std::max(most, Blocks(s.host->n, kBlock) * kSpringSums);
    PetscCall(partial_.Allocate(most));
    if (t_->beta != 0) PetscCall(undamped_.Allocate(3 * static_cast<std::size_t>(t_->n_owned)));
    CdemCuda(cudaDeviceSynchronize());  // the zeroing runs on another stream than the kernels below
  }
  double element[kElementSums] = {}, spring[kSpringSums] = {}, node[kNodeSums] = {};
  const int node_blocks = Blocks(t_->n_owned, kBlock);
  for (const Elements &e : elements_) {
    const int blocks = Blocks(e.host->n, kBlock);
    VisitElement(e.host->shape, [&](auto form) {
      BlockLaws::Visit(e.host->law, [&](auto law) {
        ElementObserveKernel<decltype(form), decltype(law)>
            <<<blocks, kBlock, 0, stream>>>(View(e, nodes.u, nodes.v, 0), partial_.get());
      });
    });
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(blocks, kElementSums, element, 0));
  }
  for (const Springs &s : springs_) {
    const int blocks = Blocks(s.host->n, kBlock);
    JointLaws::Visit(s.host->law, [&](auto law) {
      SpringObserveKernel<decltype(law), false>
          <<<blocks, kBlock, 0, stream>>>(View(s, nodes.u, nodes.v, 0), partial_.get());
    });
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(blocks, kSpringSums, spring, 0));
  }
  if (t_->beta != 0 && t_->n_owned > 0) {
    // the kick of the coming step includes the damping forces: a second evaluation, its other sums dropped
    SumKernel<<<node_blocks, kBlock, 0, stream>>>(t_->n_owned, Lists(), undamped_.get());
    for (const Elements &e : elements_)
      VisitElement(e.host->shape, [&](auto form) {
        BlockLaws::Visit(e.host->law, [&](auto law) {
          ElementKernel<decltype(form), decltype(law), true>
              <<<Blocks(e.host->n, kBlock), kBlock, 0, stream>>>(View(e, nodes.u, nodes.v, t_->beta), nullptr);
        });
      });
    for (const Springs &s : springs_)
      JointLaws::Visit(s.host->law, [&](auto law) {
        SpringObserveKernel<decltype(law), true>
            <<<Blocks(s.host->n, kBlock), kBlock, 0, stream>>>(View(s, nodes.u, nodes.v, t_->beta), partial_.get());
      });
  }
  if (t_->n_owned > 0) {
    const double *f = t_->beta != 0 ? undamped_.get() : nullptr;
    if (t_->records.n > 0)
      NodeObserveKernel<true><<<node_blocks, kBlock, 0, stream>>>(nodes, args, Lists(), mass_.get(), f, partial_.get());
    else
      NodeObserveKernel<false>
          <<<node_blocks, kBlock, 0, stream>>>(nodes, args, Lists(), mass_.get(), f, partial_.get());
    CdemCuda(cudaStreamSynchronize(stream));
    PetscCall(AddPartial(node_blocks, kNodeSums, node, 2));
  }
  *observed = Observed{node[0],
                       element[0],
                       spring[0],
                       node[1],
                       {node[2], node[3], node[4]},
                       node[5],
                       node[6],
                       element[1] + spring[1],
                       element[2] + spring[2],
                       spring[3],
                       spring[4],
                       node[7],
                       node[8]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DeviceTables::DownloadHistories(std::vector<SpringHistory> *histories) const {
  PetscFunctionBeginUser;
  histories->resize(springs_.size());
  for (std::size_t g = 0; g < springs_.size(); ++g) {
    PetscCall(springs_[g].state.Download(&(*histories)[g].state));
    PetscCall(springs_[g].slip.Download(&(*histories)[g].slip));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
