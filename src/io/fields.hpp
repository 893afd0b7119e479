// Frames for ParaView: the blocks (displacement, velocity, stress, region) and the interfaces (opening, slip, stresses,
// state), each as a series of its own.
#pragma once
#include "forces/backend.hpp"
#include "forces/element_fields.hpp"
#include "io/vtk_series.hpp"

namespace cdem {

class Options;

class FieldOutput {
 public:
  /// Reads -output_fields (collective).
  PetscErrorCode Create(MPI_Comm comm, Options &options);
  /// Says what the frames are of, in a folder that exists. All is borrowed. [in] of_laws: the fields that some
  /// stage has.
  void Open(const std::string &dir, const Mesh &mesh, const Nodes &nodes, const Tables &tables,
            const std::vector<int> &face_interface, const LawFields &of_laws);
  /// Writes the mesh files of what is there from now on (collective). [in] removed: regions that have left, one flag each;
  /// number: how often some have left before.
  PetscErrorCode WriteMesh(const std::vector<char> &removed, int number);
  /// Goes on behind the frames of an earlier run.
  PetscErrorCode Continue(EarlierRun *earlier);
  /// One frame from host copies at u(n) and the histories of the step before. [in] v_now: [n_owned][3]; stress: [owned
  /// cells][6]; springs: with each force.
  PetscErrorCode Write(PetscInt step, double time, const double *u, const std::vector<double> &v_now,
                       const std::vector<double> &stress, const SpringResults &springs, const Histories &history);

 private:
  PetscErrorCode WriteInterfaceMesh(const std::vector<char> &removed, int number);
  std::vector<double> OfLive(const double *values, int components) const;
  PetscErrorCode WriteInterfaces(PetscInt step, double time, const double *u, const SpringResults &springs,
                                 const std::vector<SpringHistory> &history);
  bool Wants(const char *field) const;

  MPI_Comm comm_ = MPI_COMM_NULL;
  const Mesh *mesh_ = nullptr;
  const Nodes *nodes_ = nullptr;
  const Tables *tables_ = nullptr;
  const std::vector<int> *face_interface_ = nullptr;
  std::string dir_;
  std::vector<std::string> wanted_;  // empty: all
  std::vector<PetscInt> live_;       // owned cells that are there
  std::vector<double> region_, interface_;
  std::vector<int> row_of_face_;      // row of the interface mesh, -1 otherwise
  std::vector<PetscInt> face_nodes_;  // per point of the interface mesh: node on the side of cell[0]
  bool with_interfaces_ = false;
  LawFields of_laws_;
  VtkSeries blocks_, interfaces_;
};

}  // namespace cdem
