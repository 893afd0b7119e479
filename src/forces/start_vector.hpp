// Where the Lanczos steps of the sharp critical step begin.
#pragma once
#include "core/host_device.hpp"
#include "core/random.hpp"

#include <Random123/philox.h>
#include <petscvec.h>

#include <vector>

namespace cdem {

/// A random vector, by the nodes' global numbers, and what is added to some components.
struct StartParts {
  std::uint64_t key = 0;
  double size = 0;            ///< the random components lie between -size and size
  std::vector<long long> at;  ///< components of owned nodes, 3 node + axis
  std::vector<double> added;
};

/// The random components of a node: the same on every rank and machine.
CDEM_HD void RandomComponents(std::uint64_t key, double size, std::int64_t node, double x[3]) {
  r123::Philox4x64 random;
  const r123::Philox4x64::ctr_type counter = {{static_cast<std::uint64_t>(node), 0, 0, 0}};
  const r123::Philox4x64::key_type keys = {{key, 0}};
  const r123::Philox4x64::ctr_type bits = random(counter, keys);
  for (int k = 0; k < 3; ++k) x[k] = size * (2 * UnitReal(bits[k]) - 1);
}

#ifdef CDEM_HAVE_CUDA
/// Fills a Vec of the GPU there. [in] global: numbers of the owned nodes.
PetscErrorCode FillCudaStart(const std::vector<std::int64_t> &global, const StartParts &parts, Vec start);
#endif

}  // namespace cdem
