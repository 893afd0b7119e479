// Random joint model: sets of disc-shaped joints, drawn or read from a file, and the element faces that they take.
#pragma once
#include "joints/bins.hpp"
#include "mesh/interfaces.hpp"

namespace cdem {

class Options;

/// A set as the options describe it, its discs, and the figures for the header.
struct JointSet {
  std::string name;
  int region = -1;          ///< index into the mesh's regions, -1 for all of them
  std::string file;         ///< "" when the discs are drawn
  double p32 = 0;           ///< wanted disc area per volume [1/m], 0 if not given
  double count = 0;         ///< wanted disc centres per volume [1/m^3], 0 if not given
  JointLaw law;             ///< of drawn discs
  std::vector<Disc> discs;  ///< those that reach the region

  double lower[3], upper[3];     ///< bounding box of the region [m]
  double volume = 0;             ///< of the region [m^3]
  double disc_area = 0;          ///< of all discs, inside the region [m^2]
  std::int64_t inner_faces = 0;  ///< of the mesh: between two elements of the region
  std::int64_t taken_faces = 0;  ///< of the mesh: those of them that a disc takes
  double taken_area = 0;         ///< their area [m^2]
  double P32() const { return disc_area / volume; }
  double FaceShare() const { return inner_faces > 0 ? static_cast<double>(taken_faces) / inner_faces : 0; }
  double AreaRatio() const { return disc_area > 0 ? taken_area / disc_area : 0; }
};

/// Reads -joints and -joint_<name>_*, makes the discs of all sets and finds their faces (collective). Everything but the
/// indices of faces is the same on all ranks, and does not depend on their number.
/// [out] faces: per set, indices into mesh.faces; remarks: what was left out. Errors: everything wrong in the options and
/// files, with its place.
PetscErrorCode CreateJointSets(const Mesh &mesh, Options &options, std::vector<JointSet> *sets,
                               std::vector<FaceSet> *faces, std::vector<std::string> *remarks);

/// Reads the descriptions alone, and the discs of sets with a file.
PetscErrorCode ReadJointSets(const Mesh &mesh, Options &options, std::vector<JointSet> *sets);

/// Reads lines 'x y z dip dip_direction diameter' (m, degrees); commas or blanks, # begins a comment. Errors name the
/// file and the line. [in] spelled: the option, for messages.
PetscErrorCode ReadDiscs(MPI_Comm comm, const std::string &spelled, const std::string &path, std::vector<Disc> *discs);

/// All discs as lines of comma-separated values, with a header: the text of joints.csv.
std::string DiscTable(const std::vector<JointSet> &sets);

/// Faces between two elements (of one region, unless it is -1) whose centroids a disc of the set separates and whose own
/// centroid projects inside that disc; fills the figures of the set (collective).
class FaceTaker {
 public:
  explicit FaceTaker(const Mesh &mesh);
  PetscErrorCode Take(JointSet *set, std::vector<PetscInt> *faces) const;

 private:
  const Mesh &mesh_;
  std::vector<double> cell_centre_, face_centre_;  // [n][3] m
  std::vector<PetscInt> face_;                     // [n] those with two cells
  PointBins bins_;
};

}  // namespace cdem
