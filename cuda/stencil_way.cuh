// The way of stencils on the GPU: one kernel a step, a warp for nodes with one row of the stiffness.
#pragma once
#include "cuda/kernel_common.cuh"
#include "cuda/launch.cuh"
#include "cuda/step_graph.cuh"
#include "forces/node_step.hpp"
#include "forces/stencil.hpp"

namespace cdem {

/// What a warp works on.
struct StencilTile {
  int first, count;     ///< entries
  std::int64_t list;    ///< where the neighbours of its positions begin, or -1: at place + offset
  double inverse_mass;  ///< 1/kg
  int records, unused;
};

/// The plan and the state as pointers, device. Components stand apart, stride numbers from each other.
struct StencilView {
  int n_tiles;
  const StencilTile *tile;
  const int *position, *list, *node;
  const StencilEntry *entry;
  double *u, *v, *w[2];  ///< without damping by stiffness the displacements stand in w alone
  long long stride;
  int *step;  ///< [2] of the batch, by buffer
};

class StencilWay {
 public:
  /// [in] any: even where it does not pay. [out] why: the scene cannot go this way, or nothing.
  PetscErrorCode Create(const Tables &tables, bool any, std::string *why);
  std::size_t Bytes() const;
  std::string Text() const { return text_; }

  /// Equal steps `first` to `first + n - 1` of a batch. [in,out] nodes: the state, in the order of local nodes.
  PetscErrorCode Run(const NodeView &nodes, const StepArgs &args, BatchState *batch, int first, int n,
                     const LaunchArgs &launch);
  /// To be called when addresses in the view of nodes change.
  void Drop() { graphs_.Drop(); }

 private:
  StencilView View() const;

  std::string text_;
  int places_ = 0, tiles_ = 0;
  double beta_ = 0;
  DeviceArray<StencilTile> tile_;
  DeviceArray<int> position_, list_, node_, step_;
  DeviceArray<StencilEntry> entry_;
  DeviceArray<double> state_;
  StepGraphs graphs_;
};

}  // namespace cdem
