// The numbers of every region and interface, read from the options and checked.
#pragma once
#include "core/petsc.hpp"
#include "physics/law.hpp"

#include <string>
#include <vector>

namespace cdem {

class Options;

/// A region's law and its numbers.
struct Material {
  int law = 0;                ///< number in BlockLaws
  double density = 0;         ///< kg/m^3
  double lambda = 0, mu = 0;  ///< elastic part [Pa]
  double param[kMaxParams] = {};
};

/// An interface's law and its numbers. Stiffness is per area [Pa/m]; negative: stiffness_factor times that of the blocks.
struct Joint {
  int law = 0;  ///< number in JointLaws
  double kn = -1, ks = -1, stiffness_factor = 20;
  bool broken = false;  ///< from the start
  double param[kMaxParams] = {};
};

/// Reads -block_<region>_*. Errors: a region without material, a value out of its range.
PetscErrorCode ReadMaterials(Options &options, const std::vector<std::string> &regions,
                             std::vector<Material> *materials);

/// Reads -interface_<name>_*; remarks receives what was changed (a tension above cohesion / tan(phi) is cut to it).
PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, std::vector<Joint> *joints,
                          std::vector<std::string> *remarks);

}  // namespace cdem
