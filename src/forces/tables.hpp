// The flat tables on which a step works. Built once on the host; a device backend copies them. A scene has only the
// tables that it needs: an absent feature is an empty vector.
#pragma once
#include "mesh/split.hpp"
#include "physics/materials.hpp"

#include <cstdint>
#include <vector>

namespace cdem {

/// The elements of one shape and law, in ascending global number: those of this rank, and of the overlap those
/// that touch an owned node. Rows are padded to n_pad by repeating the last element; a padded row adds nothing.
struct ElementTable {
  Shape shape = Shape::kHex;
  int form = 0, law = 0;  ///< numbers in the shape's list of forms and in BlockLaws
  int corners = 0;
  int states = 0;         ///< doubles of history an element (points times kState); 0: none, and no state byte
  bool breaks = false;    ///< the law breaks elements
  bool judged = false;    ///< by their mean stress, and the time of it is kept
  bool averages = false;  ///< the form averages its dilatation over neighbours: forces/dilatation.hpp
  int n = 0, n_pad = 0;
  std::vector<int> node;      ///< [corner][n_pad] local node
  std::vector<int> material;  ///< [n_pad] row of the parameter table
  std::vector<int> region;    ///< [n_pad] region of the mesh
  std::vector<int> cell;      ///< [n] local cell; below Mesh::n_owned: counted by this rank
  std::vector<int> layer;     ///< [n_pad] of Tables::layers; empty unless it averages
  std::size_t corner_start =
      0;  ///< first slot of this table among the corner forces of all tables [slots of 3 doubles]

  int Node(int corner, int e) const { return node[static_cast<std::size_t>(corner) * n_pad + e]; }
  /// Place of a corner in arrays [node][layer].
  std::size_t Layered(int layers, int corner, int e) const {
    return static_cast<std::size_t>(Node(corner, e)) * layers + layer[e];
  }
};

/// The springs of one interface law, in the order of (global cell, local face, corner): those with an owned node and
/// those of the faces that this rank reports.
struct SpringTable {
  int law = 0;
  int n_state = 0;  ///< doubles of history a spring
  int n = 0, n_pad = 0;
  std::vector<int> a, b;              ///< [n_pad] local nodes
  std::vector<double> normal;         ///< [3][n_pad] from a's block to b's
  std::vector<double> area;           ///< [n_pad] A_j [m^2]
  std::vector<double> kn, ks;         ///< [n_pad] K_n = k_n A_j, K_s [N/m]
  std::vector<int> joint;             ///< [n_pad] row of the parameter table
  std::vector<int> interface;         ///< [n] number of the interface
  std::vector<int> face;              ///< [n] face of the mesh
  std::vector<std::uint8_t> counted;  ///< [n_pad] 1 where this rank reports the spring (it owns the face's first cell)
  std::vector<std::uint8_t> state;    ///< [n_pad] SpringState bits at the start; empty without history
  std::vector<int> cell;              ///< [n][2] local cells whose breaking breaks the spring, or -1; empty: none does
  std::size_t force_start = 0;        ///< first slot of this table among the corner forces
};

/// Kinds of a node's component.
enum Prescribed { kFree = 0, kVelocity = 1, kDisplacement = 2 };

/// What only some nodes have: prescribed components, loads, a history. Rows exist for those nodes alone.
struct NodeRecords {
  int n = 0;
  std::vector<int> of_node;             ///< [n_owned] row or -1; empty when there are no rows
  std::vector<std::uint8_t> kind;       ///< [n] Prescribed of x, y, z, two bits each
  std::vector<double> value;            ///< [n][3] m or m/s, times the table
  std::vector<int> table;               ///< [n][3] table of each component
  std::vector<int> load_start;          ///< [n + 1]
  std::vector<int> load_table;          ///< per load
  std::vector<double> load;             ///< per load [3] N
  std::vector<std::uint8_t> load_wave;  ///< per load: 1 where it is that of a wave coming in through a quiet boundary
  std::vector<int> watch;               ///< [n] slot of the history buffer, or -1
  std::vector<int> quiet;               ///< [n] row of dashpot, or -1; empty where no node has dashpots
  std::vector<double> dashpot;          ///< [quiet nodes][6] C of quiet boundaries [N s/m], in the order of small.hpp
};

/// Everything a backend needs, on the host.
struct Tables {
  MPI_Comm comm = MPI_COMM_NULL;
  int n_owned = 0, n_local = 0;      ///< nodes
  PetscSF halo = nullptr;            ///< borrowed from Nodes
  bool releases = false;             ///< elements that break break the springs of their faces
  int n_cells = 0;                   ///< local cells, those of the overlap too
  PetscSF cells = nullptr;           ///< borrowed from Mesh: owned cells to those of the overlap; NULL on one rank
  std::vector<double> x;             ///< [n_local][3] m
  std::vector<double> mass;          ///< [n_owned] kg
  std::vector<double> inverse_mass;  ///< [n_owned] 1/kg
  std::vector<ElementTable> elements;
  std::vector<SpringTable> springs;
  std::vector<double> block_param;     ///< [row][kMaxParams]
  std::vector<double> joint_param;     ///< [row][kMaxParams]
  int layers = 0;                      ///< regions whose elements average their dilatation; 0: no averaging anywhere
  std::vector<double> inverse_volume;  ///< [n_owned][layer] 1/m^3, of a node's elements of that layer; 0 without any
  std::vector<double> layer_bulk;      ///< [layer] the largest bulk modulus of its elements on any rank [Pa]
  NodeRecords records;
  int n_watch = 0;                ///< slots of the history buffer on this rank
  int n_tables = 1;               ///< time tables; table 0 is the constant 1
  double gravity[3] = {0, 0, 0};  ///< m/s^2
  double beta = 0;                ///< Rayleigh damping by stiffness [s]
  bool damped = false;            ///< nodes have local damping or scaled masses
  bool combined = false;          ///< the damping is FLAC's combined one, which remembers accelerations
  std::vector<double> weight;     ///< [n_owned] true mass over that of the step; empty unless masses are scaled
  std::size_t n_slots = 0;        ///< corner and spring force slots of all tables
};

/// What the nodes of a scene have: their loops are made for it.
template <bool records, bool quiet, bool damped>
struct NodeKind {
  static constexpr bool kRecords = records, kQuiet = quiet, kDamped = damped;
};
/// f(NodeKind{}) of these tables.
template <class F>
auto VisitNodes(const Tables &t, F &&f) {
  const bool quiet = !t.records.quiet.empty();
  if (t.damped)
    return quiet             ? f(NodeKind<true, true, true>{})
           : t.records.n > 0 ? f(NodeKind<true, false, true>{})
                             : f(NodeKind<false, false, true>{});
  return quiet             ? f(NodeKind<true, true, false>{})
         : t.records.n > 0 ? f(NodeKind<true, false, false>{})
                           : f(NodeKind<false, false, false>{});
}

/// Builds element and spring tables and nodal masses (collective).
/// Errors: more nodes or corners on a rank than a 32-bit count holds; a node without mass.
/// [in] removed: regions that are not there any more, one flag each; empty: none. Nodes of theirs alone have no mass.
PetscErrorCode BuildTables(const Mesh &mesh, const Nodes &nodes, const std::vector<int> &face_interface,
                           const std::vector<Material> &materials, const std::vector<Joint> &joints,
                           const std::vector<char> &removed, Tables *tables);

/// Whether a cell has left with its region. [in] removed: one flag a region; empty: none.
inline bool IsRemoved(const Mesh &mesh, const std::vector<char> &removed, PetscInt cell) {
  return !removed.empty() && removed[mesh.cell_region[cell]];
}

/// Distance of the centres of the two cells of an inner face [m].
double CentreDistance(const Mesh &mesh, const Face &face);

/// Local nodes at corner j of a face, on the side of cell[side].
PetscInt FaceNode(const Mesh &mesh, const Nodes &nodes, const Face &face, int j, int side);

/// Corner of the mesh's face at which each spring of a table stands.
std::vector<int> SpringCorners(const Mesh &mesh, const Nodes &nodes, const SpringTable &table);

}  // namespace cdem
