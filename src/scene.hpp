// What the options say of one stage of a run: all that may change from stage to stage.
#pragma once
#include "core/options.hpp"
#include "loads/boundary.hpp"
#include "time/relaxation.hpp"

namespace cdem {

struct Scene {
  std::string name;  ///< of the stage; "" in a run without stages
  std::vector<Material> materials;
  std::vector<Joint> joints;
  std::vector<std::string> table_names;
  std::vector<TimeTable> tables;
  std::vector<Boundary> boundaries;
  double gravity[3] = {0, 0, 0};                        ///< m/s^2
  double alpha = 0, beta = 0, local = 0;                ///< damping [1/s, s, -]
  double strength_factor = 1;                           ///< strengths are divided by it
  std::vector<char> removed;                            ///< [region] taken out in this stage or an earlier one
  bool removes = false, reset = false, intact = false;  ///< in this stage
  bool relax = false;
  RelaxPlan relaxation;

  // time
  bool dt_given = false, has_end_time = false, has_end_step = false;
  double dt = 0, safety = 0.9, end_time = 0;  ///< s; the end counts from the stage's beginning
  PetscInt end_step = PETSC_INT_MAX;
  std::string check = "error";  ///< -ts_central_check
  std::string limit = "sharp";  ///< -ts_central_limit
};

/// Reads -stages and what every one of them says; a run without stages is one of them, without a name (collective).
/// [in] interfaces: their names; face_interface: which of them has each face of the mesh, -1: none.
/// Remarks come once. Errors: all that a value, a name or a combination can have wrong.
PetscErrorCode ReadScenes(Options &options, const Mesh &mesh, const std::vector<std::string> &interfaces,
                          const std::vector<int> &face_interface, std::vector<Scene> *scenes,
                          std::vector<std::string> *remarks);

}  // namespace cdem
