// Checkpoints: everything that a run needs to go on, in one HDF5 file checkpoint_<step>.h5, the same on any number of ranks.
#pragma once
#include "core/option_list.hpp"
#include "io/audit_rows.hpp"
#include "io/fingerprint.hpp"
#include "io/hdf5_reader.hpp"
#include "io/history_rows.hpp"
#include "io/interval.hpp"

#include <map>
#include <memory>

namespace cdem {

class Options;

/// The numbers of a run beside its arrays, by name: step, time, dt, ... A reader keeps those that it does not know.
using Numbers = std::map<std::string, double>;
/// Vectors of the owned nodes [n_owned][3] beside displacement and velocity, by name; the same names on all ranks.
using NodeFields = std::vector<std::pair<std::string, const double *>>;

/// What a checkpoint is taken of. All is borrowed.
struct CheckpointScene {
  const Mesh *mesh = nullptr;
  const Nodes *nodes = nullptr;
  const Tables *tables = nullptr;
  Fingerprint fingerprint;
  std::vector<GivenOption> options;  ///< of the scene
  bool audited = false;              ///< the energy audit is on
  int stage = 0;                     ///< the one that is computed, from 0
};

/// Writes checkpoints when they are due, and keeps the last two.
class CheckpointWriter {
 public:
  /// Reads -checkpoint_interval and -checkpoint_interval_time. [in] dir: the output folder, "" if there is none.
  PetscErrorCode ReadOptions(Options &options, const std::string &dir);
  bool Active() const { return !interval_.Never(); }
  PetscInt ToNext(PetscInt step, double time, double dt) const { return interval_.ToNext(step, time, dt); }
  /// Never at the step at which the run begins: nothing is new there.
  bool Due(PetscInt step, double time, double dt, bool last, PetscInt first) const {
    return Active() && step != first && (last || interval_.Due(step, time, dt));
  }
  /// Writes one safely (temporary file, onto the disk, rename), then removes all but the last two. [in] u, v: [n_owned][3]
  /// (host), v at the half step; more: what else the nodes remember; history, audit: of the same moment. Collective.
  PetscErrorCode Write(const CheckpointScene &scene, PetscInt step, const Numbers &numbers, const double *u,
                       const double *v, const NodeFields &more, const Histories &history, const AuditArrays &audit);

 private:
  std::string dir_;
  Interval interval_;
};

/// A checkpoint to start from.
class CheckpointReader {
 public:
  /// Opens it and reads all of it once, to be sure that it is whole. Errors: missing, no checkpoint, of a later program,
  /// cut short, damaged. Collective.
  PetscErrorCode Open(MPI_Comm comm, const std::string &path);
  const std::string &path() const { return path_; }
  /// A number by its name; an error of the file when it lacks it is told by Open for those that every checkpoint has.
  double Number(const char *name) const;
  PetscInt Integer(const char *name) const { return static_cast<PetscInt>(Number(name)); }
  PetscInt step() const { return static_cast<PetscInt>(Number("step")); }
  double time() const { return Number("time"); }
  /// Error unless the scene is the same: which option was what and is what now, or which part of the model differs.
  PetscErrorCode CheckScene(const CheckpointScene &scene);
  /// Reads u, v [n_owned][3] and the histories of this rank (collective).
  PetscErrorCode ReadState(const CheckpointScene &scene, std::vector<double> *u, std::vector<double> *v,
                           Histories *history);
  /// Reads what the energy audit had added up; the checkpoint has the number "audit" (collective).
  PetscErrorCode ReadAudit(const CheckpointScene &scene, AuditArrays *audit);
  /// Reads a vector of the nodes [n_owned][3] (collective); empty when the file has none of that name.
  PetscErrorCode ReadNodes(const CheckpointScene &scene, const std::string &name, std::vector<double> *values);

 private:
  PetscErrorCode CheckContent();
  PetscErrorCode ReadText(const std::string &name, std::string *text);
  PetscErrorCode ReadHistory(const HistoryRows &kind, Histories *history);

  MPI_Comm comm_ = MPI_COMM_NULL;
  std::string path_;
  std::unique_ptr<Hdf5Reader> file_;
  Numbers numbers_;
};

}  // namespace cdem
