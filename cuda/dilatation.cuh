// Averaging of the dilatation of tetrahedra bbar on the GPU: as on the CPU (forces/dilatation.hpp), by lists of the
// elements of every node, so that the sums have the CPU's order.
#pragma once
#include "cuda/device_array.cuh"
#include "cuda/kernel_common.cuh"

namespace cdem {

/// What the elements of a table share with their nodes. Arrays of nodes are [node][layer][rate].
struct AverageView {
  const int *layer = nullptr;
  int layers = 0, rates = 1;
  const double *mean = nullptr;  ///< dilatation at the nodes
  double *swelling = nullptr;    ///< [n_pad][rate] integrals of dilatation [m^3]
  double *pressure = nullptr;    ///< [n_pad] integrals of pressure [N m]
};

/// Means at the four nodes of an element.
__device__ __forceinline__ void NodeMeans(const AverageView &t, const int *node, int n_pad, int e, const double *mean,
                                          int rates, int rate, double of_node[4]) {
#pragma unroll
  for (int a = 0; a < 4; ++a) {
    const long long row = static_cast<long long>(node[static_cast<long long>(a) * n_pad + e]) * t.layers + t.layer[e];
    of_node[a] = mean[rates * row + rate];
  }
}

/// Device memory of the averaging; empty in scenes without it.
struct DeviceAverages {
  DeviceArray<int> start, entry;                   ///< elements of every owned node and layer, in ascending order
  DeviceArray<double> inverse_volume;              ///< [n_owned][layer] 1/m^3
  DeviceArray<double> dilatation, pressure;        ///< at the nodes
  DeviceArray<double> of_dilatation, of_pressure;  ///< integrals of the elements
  DeviceArray<double> before;                      ///< dilatation of the step before, for the energy audit
};

}  // namespace cdem
