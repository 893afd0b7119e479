// Everything that looks at a run while it goes: monitors, histories and frames. None of it touches the state.
#pragma once
#include "forces/backend.hpp"
#include "io/fields.hpp"
#include "io/interval.hpp"
#include "io/output_dir.hpp"
#include "loads/boundary.hpp"

namespace cdem {

class Options;

/// A named number of the energy balance [J], for the monitor's columns.
struct NamedEnergy {
  const char *name;
  double value;
};

/// What a monitor sees: sums over all ranks at u(n).
struct Sight {
  PetscInt step = 0, last_step = PETSC_INT_MAX;  ///< last_step: where the run ends, as far as known
  PetscInt first_step = 0;                       ///< where it began
  double time = 0, wall = 0;                     ///< s; wall since the solve began
  double elements = 0;                           ///< of the whole mesh
  double breakable = 0;                          ///< elements of laws that break them
  Observed observed;
  std::vector<NamedEnergy> energies;  ///< of the audit, in the order of the columns
};

/// One monitor: its option, what it prints, and when it does by default.
struct MonitorRow {
  const char *option;
  const char *header;
  bool observes;  ///< needs the sums of an observation
  PetscErrorCode (*print)(PetscViewer viewer, const Sight &sight);
  const char *of_breakable = nullptr;  ///< end of the header in scenes whose elements may break
  bool audits = false;                 ///< needs the energy audit, and its names end the header
};
/// The table of monitors: a new one is a row here.
extern const MonitorRow kMonitors[];
extern const int kMonitorCount;

/// Reads -<prefix>interval and -<prefix>interval_time over a default.
PetscErrorCode ReadInterval(Options &options, const std::string &prefix, Interval *interval);

/// Adds an observation's sums over the ranks.
PetscErrorCode SumOverRanks(MPI_Comm comm, Observed *observed);

/// The monitors that the options ask for.
class Monitors {
 public:
  ~Monitors();
  /// [in] last_step: number of steps of the run if known, else PETSC_INT_MAX.
  PetscErrorCode ReadOptions(Options &options, PetscInt last_step);
  /// Creates the viewers, and with them their files; when everything else has been checked.
  /// [in] energies: names of Sight::energies, each after a blank.
  PetscErrorCode Open(MPI_Comm comm, bool breakable, const std::string &energies);
  PetscInt ToNext(PetscInt step, double time, double dt) const;
  bool Due(PetscInt step, double time, double dt, bool last) const;
  bool Observes(PetscInt step, double time, double dt, bool last) const;
  bool Audits(PetscInt step, double time, double dt, bool last) const;
  PetscErrorCode Print(const Sight &sight, double dt, bool last);

 private:
  struct Active {
    const MonitorRow *row;
    PetscViewer viewer;
    PetscViewerFormat format;
    Interval interval;
  };
  std::vector<Active> active_;
};

/// Rows of histories.csv, gathered from the ranks that own the nodes.
class HistoryRecorder {
 public:
  PetscErrorCode ReadOptions(Options &options);
  /// Begins histories.csv in a folder that exists; the histories know their slots by now.
  /// [in] append: behind the rows of an earlier run.
  PetscErrorCode Open(MPI_Comm comm, const std::string &dir, const std::vector<History> &histories, bool append);
  bool Empty() const { return histories_.empty(); }
  /// Displacements count from these of the owned nodes [n_owned][3] from now on.
  PetscErrorCode SetOrigin(const double *u);
  /// Rows of a batch that began with step first, at these times; buffer [n][n_watch][6] holds the slots of this rank.
  PetscErrorCode Record(PetscInt first, const std::vector<double> &times, const double *buffer, int n_watch);
  /// The row of the last state, from u and v(n) of the owned nodes. Collective.
  PetscErrorCode RecordLast(PetscInt step, double time, const double *u, const double *v_now);

 private:
  PetscErrorCode Write(const std::vector<PetscInt> &steps, const std::vector<double> &times,
                       std::vector<double> &values);
  MPI_Comm comm_ = MPI_COMM_NULL;
  PetscMPIInt rank_ = 0;
  PetscInt interval_ = 1;
  std::vector<History> histories_;
  std::vector<double> origin_;  // per history; 0 where another rank owns the node
  HistoryFile file_;
};

}  // namespace cdem
