// The loops over elements, springs and nodes on the CPU: lanes of kLanes elements or springs at a time, scattered one by
// one in ascending global order, so that the sums do not depend on the partition.
#pragma once
#include "forces/bodies.hpp"

namespace cdem {

/// What springs with history remember, per spring table: state [n_pad], slip [3][n_pad] m.
struct SpringHistory {
  std::vector<std::uint8_t> state;
  std::vector<double> slip;
};

/// Per-element results of an observing pass, optional (NULL: not wanted).
struct ElementResults {
  double *stress = nullptr;  ///< [n local cells][6], mean over the element [Pa]
  double energy = 0;         ///< J, of the elements this rank owns
  double force_sum = 0;      ///< sum of |component| of corner forces [N]
  double force_count = 0;
};

/// Per-spring results of an observing pass.
struct SpringResults {
  std::vector<std::vector<double>> force;        ///< per table [3][n_pad] N, on b; empty when not wanted
  std::vector<std::vector<std::uint8_t>> state;  ///< per table [n_pad], as a committing pass would leave it
  bool want_each = false;
  double energy = 0, force_sum = 0, force_count = 0;
  double broken = 0, count = 0;  ///< springs this rank counts
};

/// Adds internal forces of all elements to f [n_local][3]. kObserve fills results. With beta != 0 the force is that of
/// u + beta v.
void HostElements(const Tables &tables, const double *u, const double *v, double beta, double *f);
void HostElementsObserve(const Tables &tables, int n_owned_cells, const double *u, double *f, ElementResults *results);

/// Adds the forces of all springs to f and commits state and slip.
void HostSprings(const Tables &tables, const double *u, const double *v, double beta,
                 std::vector<SpringHistory> &history, double *f);
/// The same without committing anything.
void HostSpringsObserve(const Tables &tables, const double *u, const double *v, double beta,
                        const std::vector<SpringHistory> &history, double *f, SpringResults *results);

/// Starting histories of all spring tables.
std::vector<SpringHistory> StartHistories(const Tables &tables);

}  // namespace cdem
