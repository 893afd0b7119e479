// The way of stencils on the CPU.
#pragma once
#include "forces/backend.hpp"
#include "forces/stencil.hpp"

namespace cdem {

/// Steps of a linear scene of congruent elements: lanes of nodes with one row, neighbours by offsets.
class HostStencil {
 public:
  /// Returns why the scene cannot go this way, or nothing. [in] any: even where it does not pay.
  std::string Create(const Tables &tables, bool any);
  std::size_t Bytes() const;
  std::string Text() const;

  /// Equal steps `first` to `first + n - 1` of a batch. [in,out] nodes: the state, in the order of local nodes.
  void Run(const NodeView &nodes, const StepArgs &args, int first, int n, Failure *failure);

 private:
  /// Places from `place` on, as many as there are lanes; those of the class are in the mask.
  struct Tile {
    int place, mask;
  };
  /// What a class has by lanes, tiles whose places are all of it first; the rest of it, by position, one by one.
  struct Work {
    int of;
    int full, part, end;     ///< tiles [full, part) and [part, end)
    int one_begin, one_end;  ///< positions
  };
  void MakeTiles(int of);
  template <bool kBeta>
  void Step(const NodeView &nodes, const StepArgs &args, int step, const double *now, double *next, Failure *failure);
  template <bool kBeta, int kTiles>
  void Lanesful(const StencilClass &c, const Tile *tiles, const StepArgs &args, const double *now, double *next,
                int step, Failure *failure);
  template <bool kBeta>
  void One(const StencilClass &c, int position, const NodeView &nodes, const StepArgs &args, int step,
           const double *now, double *next, Failure *failure);
  void Blame(int step, int place, int mask, Failure *failure) const;

  StencilPlan plan_;
  std::vector<Tile> tile_;
  std::vector<Work> work_;
  double beta_ = 0;
  std::size_t stride_ = 0;            ///< from one component to the next
  std::vector<double> u_, v_, w_[2];  ///< [3][place]; without beta the displacements stand in w alone
};

}  // namespace cdem
