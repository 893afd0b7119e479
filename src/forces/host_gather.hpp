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

/// Three components of kLanes nodes from an [n][3] array.
CDEM_HD void Gather(const double *from, const int *node, Lanes out[3]) {
  alignas(sizeof(Lanes)) double buffer[3][kLanes];
  CDEM_UNROLL for (int l = 0; l < kLanes; ++l) {
    const double *p = from + 3 * static_cast<std::ptrdiff_t>(node[l]);
    buffer[0][l] = p[0];
    buffer[1][l] = p[1];
    buffer[2][l] = p[2];
  }
  for (int k = 0; k < 3; ++k) out[k] = LoadAs<Lanes>(buffer[k]);
}

}  // namespace cdem
