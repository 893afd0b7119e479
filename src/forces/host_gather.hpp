// Loading lanes from the tables on the CPU.
#pragma once
#include "core/lanes.hpp"
#include "physics/law.hpp"

#include <cstddef>
#include <vector>

namespace cdem {

/// Parameters of the kLanes rows from i on: one row where all are of one material.
CDEM_HD void LoadParams(const std::vector<double> &table, const int *row, int count, Lanes *param) {
  bool same = true;
  for (int l = 1; l < kLanes; ++l) same &= row[l] == row[0];
  for (int p = 0; p < count; ++p) {
    param[p] = Lanes{} + table[static_cast<std::size_t>(kMaxParams) * row[0] + p];
    if (!same)
      for (int l = 1; l < kLanes; ++l) param[p][l] = table[static_cast<std::size_t>(kMaxParams) * row[l] + p];
  }
}

/// One component of kLanes nodes: built in registers, since lanes written to memory one by one are slow to be read as one.
CDEM_HD Lanes GatherOne(const double *const p[kLanes], int k) {
#if defined(__AVX512F__)
  return Lanes{p[0][k], p[1][k], p[2][k], p[3][k], p[4][k], p[5][k], p[6][k], p[7][k]};
#elif defined(__AVX__)
  return Lanes{p[0][k], p[1][k], p[2][k], p[3][k]};
#else
  return Lanes{p[0][k], p[1][k]};
#endif
}

/// Three components of kLanes nodes from an [n][3] array.
CDEM_HD void Gather(const double *from, const int *node, Lanes out[3]) {
  const double *p[kLanes];
  CDEM_UNROLL for (int l = 0; l < kLanes; ++l) p[l] = from + 3 * static_cast<std::ptrdiff_t>(node[l]);
  CDEM_UNROLL for (int k = 0; k < 3; ++k) out[k] = GatherOne(p, k);
}

}  // namespace cdem
