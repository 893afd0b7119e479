// Which faces of the mesh are interfaces, and of which declared one.
#pragma once
#include "mesh/mesh.hpp"

namespace cdem {

class Options;

/// Faces that something other than the mesh has named, such as a joint set.
struct FaceSet {
  std::string name;
  std::vector<PetscInt> faces;  ///< indices into mesh.faces
};

/// Reads -interfaces and -interface_<name>_on.
/// [in] joints: the faces of each joint set; a set that no interface uses is an error.
/// [out] names: the declared interfaces, in order; face_interface: per face of the mesh, the interface that has it (the
/// later one where two claim it) or -1. Collective. Errors: an unknown surface or region, an interface without faces.
PetscErrorCode SelectInterfaces(const Mesh &mesh, Options &options, const std::vector<FaceSet> &joints,
                                std::vector<std::string> *names, std::vector<int> *face_interface);

/// The regions on both sides of a face, the lower number first.
using RegionPair = std::array<int, 2>;
RegionPair SidesOf(const Mesh &mesh, const Face &face);

/// The pairs of regions beside each of n interfaces, in order, the same on every rank (collective).
PetscErrorCode FindSides(const Mesh &mesh, const std::vector<int> &face_interface, std::size_t n,
                         std::vector<std::vector<RegionPair>> *sides);

/// "a, b, c" for messages.
std::string Joined(const std::vector<std::string> &names);

}  // namespace cdem
