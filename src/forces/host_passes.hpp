// The loops over elements, springs and nodes on the CPU: lanes of kLanes elements or springs at a time, scattered one by
// one in ascending global order, so that the sums do not depend on the partition.
#pragma once
#include "forces/audit.hpp"
#include "forces/bodies.hpp"

namespace cdem {

/// What springs with history remember, per spring table: state [n_pad], and the law's own numbers [kState][n_pad].
struct SpringHistory {
  std::vector<std::uint8_t> state;
  std::vector<double> values;
};

/// What elements of laws with history remember, per element table.
struct ElementHistories {
  std::vector<std::uint8_t> state;  ///< [n_pad] ElementState bits
  std::vector<double> value;        ///< [point][number][n_pad], as ElementHistory reads it
  std::vector<double> broken_time;  ///< [n_pad] s; NaN while intact; empty unless the law breaks elements
};

/// All history of a body: its state beside u and v.
struct Histories {
  std::vector<ElementHistories> elements;
  std::vector<SpringHistory> springs;
  std::vector<double> acceleration{};  ///< [n_owned][3] of the step before [m/s^2], in combined damping; else empty
};

/// Per-element results of an observing pass, optional (NULL: not wanted).
struct ElementResults {
  double *stress = nullptr;  ///< [n local cells][6], mean over the element [Pa]
  double broken = 0;         ///< elements broken, of those this rank owns
  double energy = 0;         ///< J, of the elements this rank owns
  double *each = nullptr;    ///< [n_owned_cells] energy of every element [J]
  double force_sum = 0;      ///< sum of |component| of corner forces [N]
  double force_count = 0;
};

/// Per-spring results of an observing pass.
struct SpringResults {
  std::vector<std::vector<double>> force;        ///< per table [3][n_pad] N, on b; empty when not wanted
  std::vector<std::vector<std::uint8_t>> state;  ///< per table [n_pad], as a committing pass would leave it
  std::vector<std::vector<double>> each;         ///< per table [n_pad] energy [J]; of those that are counted
  bool want_each = false, want_energies = false;
  double energy = 0, force_sum = 0, force_count = 0;
  double broken = 0, count = 0;  ///< springs this rank counts
};

/// Adds internal forces of all elements to f [n_local][3], with beta != 0 those of damping too; histories are committed,
/// and what breaks does so at the given time [s]. [in] audit: adds to its arrays; NULL: it is off. single: arithmetic of
/// elements in single precision, see SingleCheck.
void HostElements(const Tables &tables, const double *u, const double *v, double beta, double time,
                  std::vector<ElementHistories> &history, double *f, const AuditPass *audit = nullptr,
                  bool single = false);
/// The same without committing anything.
void HostElementsObserve(const Tables &tables, int n_owned_cells, const double *u, const double *v, double beta,
                         const std::vector<ElementHistories> &history, double *f, ElementResults *results);

/// Adds the forces of all springs to f and commits their histories.
void HostSprings(const Tables &tables, const double *u, const double *v, double beta,
                 std::vector<SpringHistory> &history, double *f, const AuditPass *audit = nullptr);
/// The same without committing anything.
void HostSpringsObserve(const Tables &tables, const double *u, const double *v, double beta,
                        const std::vector<SpringHistory> &history, double *f, SpringResults *results);

/// Pointers to the tables of the nodes on the host.
NodeView HostView(const Tables &t, double *u, double *v, const double *schedule, double *history);

/// Starting histories of all tables.
std::vector<SpringHistory> StartSprings(const Tables &tables);
std::vector<ElementHistories> StartElements(const Tables &tables);

/// Moves the nodes by a step. [in] step: of the batch; f: [n_local][3] internal forces [N]. Returns the first node whose
/// velocity is no reasonable number, or -1.
int HostNodes(const Tables &tables, const NodeView &nodes, const StepArgs &args, int step, const double *f);
/// What that step of the nodes does, to be called before it. [in,out] audit: adds to its works at nodes.
void HostNodesWork(const Tables &tables, const NodeView &nodes, const StepArgs &args, int step, const double *f,
                   AuditArrays *audit);

}  // namespace cdem
