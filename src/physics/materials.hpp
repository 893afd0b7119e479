// The numbers of every region and interface, read from the options and checked.
#pragma once
#include "core/petsc.hpp"
#include "physics/law.hpp"
#include "physics/scatter.hpp"

#include <string>
#include <vector>

namespace cdem {

class Options;

/// A region's law and its numbers.
struct Material {
  int law = 0;                           ///< number in BlockLaws
  std::string element = "full";          ///< name of the element form
  double density = 0;                    ///< kg/m^3
  double property[kMaxProperties] = {};  ///< in the order of the law's kProperties
  double param[kMaxParams] = {};         ///< of an element of size 1 m
  bool releases = false;                 ///< an element that breaks breaks the springs of its faces
  ScatterSet scatter;
  double lambda() const { return param[0]; }  ///< elastic part [Pa]
  double mu() const { return param[1]; }
  double young() const { return mu() * (3 * lambda() + 2 * mu()) / (lambda() + mu()); }
};

/// An interface's law and its numbers. Stiffness is per area [Pa/m]; negative: stiffness_factor times that of the blocks.
struct Joint {
  int law = 0;  ///< number in JointLaws
  double kn = -1, ks = -1, stiffness_factor = 20;
  bool broken = false;                   ///< from the start
  double property[kMaxProperties] = {};  ///< in the order of the law's kProperties
  double param[kMaxParams] = {};
  ScatterSet scatter;            ///< of the properties
  Scatter stiffness_scatter[2];  ///< of kn and ks
};

/// Parameters of a block law (an interface law) from its properties. [in] size: of the element [m].
void DeriveBlock(int law, const double *property, double size, double *param);
void DeriveJoint(int law, const double *property, double *param);

/// Reads -block_<region>_*; remarks, where wanted, receives what was changed (a tension above the apex is cut to it).
/// Errors: a region without material, a value out of its range.
PetscErrorCode ReadMaterials(Options &options, const std::vector<std::string> &regions,
                             std::vector<Material> *materials, std::vector<std::string> *remarks = nullptr);

/// Reads -interface_<name>_*; remarks receives what was changed (a tension above cohesion / tan(phi) is cut to it).
PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, std::vector<Joint> *joints,
                          std::vector<std::string> *remarks);

}  // namespace cdem
