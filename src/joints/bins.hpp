// Points sorted into a grid of bins, to find those near a disc without a look at all of them.
#pragma once
#include "joints/draw.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cdem {

/// About one point a bin. The work of a search grows with the area of the disc, not with the number of points.
class PointBins {
 public:
  /// [in] points: [n][3] m; reach: how far from the disc a point may lie and still be wanted [m].
  void Fill(const std::vector<double> &points, double reach);

  /// Calls visit(i) for every point within reach of the disc, and for some more.
  template <class Visit>
  void Near(const Disc &disc, Visit &&visit) const;

 private:
  int Bin(double x, int axis) const {
    const double at = std::floor((x - lower_[axis]) / edge_[axis]);
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(n_[axis] - 1)));
  }

  double lower_[3] = {0, 0, 0}, upper_[3] = {0, 0, 0}, edge_[3] = {1, 1, 1}, reach_ = 0;
  int n_[3] = {1, 1, 1};
  std::vector<std::size_t> begin_;  // [bins + 1], x fastest
  std::vector<std::size_t> point_;  // sorted by bin
};

template <class Visit>
void PointBins::Near(const Disc &disc, Visit &&visit) const {
  if (point_.empty()) return;
  int first[3], last[3], along = 0;
  for (int k = 0; k < 3; ++k) {
    const double n = disc.normal[k], half = disc.radius * std::sqrt(std::max(0.0, 1 - n * n)) + reach_;
    if (disc.centre[k] + half < lower_[k] || disc.centre[k] - half > upper_[k]) return;
    first[k] = Bin(disc.centre[k] - half, k);
    last[k] = Bin(disc.centre[k] + half, k);
    if (std::fabs(n) > std::fabs(disc.normal[along])) along = k;
  }
  // Columns of bins along the axis nearest to the normal; the plane says which bins of a column can hold points.
  const int a = (along + 1) % 3, b = (along + 2) % 3;
  const std::size_t stride[3] = {1, static_cast<std::size_t>(n_[0]), static_cast<std::size_t>(n_[0]) * n_[1]};
  const double na = disc.normal[a], nb = disc.normal[b], nc = disc.normal[along];
  const double thick = (0.5 * (edge_[a] * std::fabs(na) + edge_[b] * std::fabs(nb)) + reach_) / std::fabs(nc);
  for (int i = first[a]; i <= last[a]; ++i)
    for (int j = first[b]; j <= last[b]; ++j) {
      const double x = lower_[a] + (i + 0.5) * edge_[a] - disc.centre[a],
                   y = lower_[b] + (j + 0.5) * edge_[b] - disc.centre[b],
                   z = disc.centre[along] - (na * x + nb * y) / nc;
      const int from = std::max(first[along], Bin(z - thick, along)), to = std::min(last[along], Bin(z + thick, along));
      for (int k = from; k <= to; ++k) {
        const std::size_t bin = i * stride[a] + j * stride[b] + k * stride[along];
        for (std::size_t p = begin_[bin]; p < begin_[bin + 1]; ++p) visit(point_[p]);
      }
    }
}

}  // namespace cdem
