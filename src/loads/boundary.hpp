// Boundary conditions and loads: what the options say about surfaces, lines and points becomes rows of NodeRecords.
#pragma once
#include "forces/tables.hpp"
#include "loads/time_table.hpp"

namespace cdem {

class Options;

/// One declared boundary.
struct Boundary {
  std::string name;
  int surface = -1, point_set = -1;     ///< index into the mesh's lists; one of the two
  int kind[3] = {kFree, kFree, kFree};  ///< Prescribed of x, y, z
  double value[3] = {0, 0, 0};          ///< m or m/s, times the table
  bool loaded = false;                  ///< traction or pressure below
  double traction[3] = {0, 0, 0};       ///< Pa
  double pressure = 0;                  ///< Pa
  double pressure_gradient_z = 0;       ///< Pa/m
  double traction_gradient_z = 0;       ///< of the traction, as a share of it [1/m]
  bool quiet = false;                   ///< dashpots on its faces
  bool lets_go = false;                 ///< it is quiet since a stage, and was held in those before
  bool keeps_reactions = true;          ///< which go on as constant forces
  bool wave = false;                    ///< and a plane wave that comes in through them
  double incoming[3] = {0, 0, 0};       ///< particle velocity of that wave [m/s], times the table
  int table = 0;
};

/// A point at which a history is recorded.
struct History {
  std::string name, of;
  double at[3];           ///< asked for [m]
  int component = 0;      ///< 0 to 2: displacement, 3 to 5: velocity
  PetscMPIInt rank = -1;  ///< that owns the node
  int node = -1;          ///< on that rank
  int slot = -1;          ///< of that rank's history buffer
  double found[3];        ///< where the node stands [m]
};

/// Reads -boundaries and -boundary_<name>_*.
PetscErrorCode ReadBoundaries(const Mesh &mesh, Options &options, const std::vector<std::string> &table_names,
                              std::vector<Boundary> *boundaries);

/// Reads -histories and -history_<name>_*, and finds the nearest nodes (at a split vertex the one of the lowest-numbered
/// cell). Collective.
PetscErrorCode ReadHistories(const Mesh &mesh, const Nodes &nodes, Options &options, std::vector<History> *histories);

/// Turns boundaries and histories into rows of records (none when there is nothing). Where two boundaries prescribe one
/// component the later one has it; loads and dashpots add. Fixed components of v (initial velocities) are left to the
/// first step. [in] removed: as for BuildTables, which comes before; nodes without mass are held. Loads and dashpots lie on
/// the outer boundary as it is by then. A wave that comes in is the load 2 C v_in: half of it is the wave's own stress, half
/// moves the dashpots.
PetscErrorCode BuildRecords(const Mesh &mesh, const Nodes &nodes, const std::vector<Boundary> &boundaries,
                            const std::vector<Material> &materials, const std::vector<char> &removed,
                            std::vector<History> &histories, Tables *tables);

}  // namespace cdem
