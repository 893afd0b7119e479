// Which faces of the mesh are interfaces, and of which declared one.
#pragma once
#include "mesh/mesh.hpp"

namespace cdem {

class Options;

/// Reads -interfaces and -interface_<name>_on.
/// [out] names: the declared interfaces, in order; face_interface: per face of the mesh, the interface that has it (the
/// later one where two claim it) or -1. Collective. Errors: an unknown surface or region, an interface without faces.
PetscErrorCode SelectInterfaces(const Mesh &mesh, Options &options, std::vector<std::string> *names,
                                std::vector<int> *face_interface);

/// "a, b, c" for messages.
std::string Joined(const std::vector<std::string> &names);

}  // namespace cdem
