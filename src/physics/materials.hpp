// The numbers of every region and interface, read from the options and checked.
#pragma once
#include "core/petsc.hpp"
#include "mesh/interfaces.hpp"
#include "physics/law.hpp"
#include "physics/scatter.hpp"
#include "physics/strength.hpp"

#include <map>
#include <string>
#include <vector>

namespace cdem {

class Options;

using PropertyRow = std::array<double, kMaxProperties>;

/// A region's law and its numbers.
struct Material {
  int law = 0;                              ///< number in BlockLaws
  std::string element = "full";             ///< name of the element form
  double density = 0;                       ///< kg/m^3
  double property[kMaxProperties] = {};     ///< in the order of the law's kProperties
  double param[kMaxParams] = {};            ///< of an element of size 1 m
  double strength[kStrengths] = {};         ///< for interfaces, before any strength factor; infinite: it has none
  bool releases = false;                    ///< an element that breaks breaks the springs of its faces
  bool intact = false;                      ///< nothing fails
  bool restiffened = false;                 ///< its law or stiffness is another one than in an earlier stage
  bool stressed = false;                    ///< there is stress from the start:
  double stress[6] = {}, gradient[6] = {};  ///< xx, yy, zz, xy, yz, xz [Pa] at z = 0, and more per metre of z [Pa/m]
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
  bool intact = false;                   ///< nothing fails
  bool keeps_tension = false;            ///< after a failure in shear
  double property[kMaxProperties] = {};  ///< in the order of the law's kProperties
  double param[kMaxParams] = {};
  /// Where strengths that come from the blocks differ: the properties by the regions beside a face; else empty.
  std::map<RegionPair, PropertyRow> of_sides;
  ScatterSet scatter;            ///< of the properties
  Scatter stiffness_scatter[2];  ///< of kn and ks
};

/// Parameters of a region's law (an interface's) from properties. [in] size: of the element [m].
void DeriveBlock(const Material &material, const double *property, double size, double *param);
void DeriveJoint(const Joint &joint, const double *property, double *param);

/// What a stage does to strengths, of blocks and interfaces alike.
struct StrengthChange {
  double factor = 1;    ///< they are divided by it
  bool intact = false;  ///< nothing fails
};

/// Reads -block_<region>_*; remarks, where wanted, receives what was changed (a tension above the apex is cut to it).
/// Errors: a region without material, a value out of its range.
PetscErrorCode ReadMaterials(Options &options, const std::vector<std::string> &regions, const StrengthChange &change,
                             std::vector<Material> *materials, std::vector<std::string> *remarks = nullptr);

/// What lies beside the interfaces.
struct Neighbours {
  const std::vector<std::string> &regions;
  const std::vector<Material> &materials;             ///< of the regions
  const std::vector<std::vector<RegionPair>> &sides;  ///< of each interface
};

/// Reads -interface_<name>_*. A strength that is not given is the smaller of the two blocks' at each face. remarks receives
/// what was taken from blocks, and what was changed (a tension above cohesion / tan(phi) is cut to it).
PetscErrorCode ReadJoints(Options &options, const std::vector<std::string> &names, const Neighbours &blocks,
                          const StrengthChange &change, std::vector<Joint> *joints, std::vector<std::string> *remarks);

/// Takes the law of the same name that carries an offset. Error: the form cannot change its stiffness without a jump.
PetscErrorCode CarryOffset(MPI_Comm comm, const std::string &region, Material *material);
void CarryOffset(Joint *joint);

}  // namespace cdem
