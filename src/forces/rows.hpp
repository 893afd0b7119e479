// The stiffness of a linear scene as assembled rows, and of a small one their distribution over the thread blocks of a
// cluster.
#pragma once
#include "forces/tables.hpp"

#include <string>

namespace cdem {

/// Rows of the stiffness by nodes: block i of row n couples it with node column[i].
struct StiffnessRows {
  std::vector<int> start;     ///< [n_owned + 1]
  std::vector<int> column;    ///< node, ascending within a row
  std::vector<double> block;  ///< [entry][3][3] N/m, force component first
};

/// Why the rows cannot stand for a scene's forces, or nothing: they must be linear in the displacements, on one rank.
std::string NoRows(const Tables &tables);

/// Assembles the rows of a scene for which NoRows says nothing: the bodies of the loops over elements and springs, on
/// one unit displacement after the other (assembly.cxx).
StiffnessRows AssembleRows(const Tables &tables);

/// Rows over the blocks of a cluster: 4 lanes a node, each with kCouplings. A block keeps the displacements of its own
/// nodes, in slots 0 to own - 1, and of those coupled with them, its halo, after them; whoever owns a node sends it there.
/// Nodes that are sent come first among the own ones, so the first thread of a block that has a halo holds one. Nodes that
/// stand still are nobody's: who reads them has them in slots after the halo.
struct RowPlan {
  static constexpr int kLanes = 4, kCouplings = 7;  ///< of a lane
  static constexpr int kTargets = 8, kSlots = 384;  ///< blocks that read a node; slots of a block, at most
  static constexpr int kNodes = 88;                 ///< of a block at most
  int n_blocks = 0, threads = 0;                    ///< threads of a block
  std::vector<int> node;                            ///< [block][threads] local node, or -1
  std::vector<double> coefficient;                  ///< [block][kCouplings * 9][threads]
  std::vector<unsigned short> slot;                 ///< [block][kCouplings][threads]
  std::vector<int> target;          ///< [block][kNodes][kTargets] block << 16 | slot, or -1 from the last on
  std::vector<int> own;             ///< [block] its nodes
  std::vector<int> halo;            ///< [block] nodes of its halo
  std::vector<int> far_start, far;  ///< [block + 1], nodes by slot: the halo, and what stands still
};

/// Distributes rows over at most max_blocks blocks; returns why that cannot be, or nothing.
/// [in] x: [n_owned][3] m; still: [n_owned] nodes that never move. [out] plan.
std::string PlanRows(const StiffnessRows &rows, const std::vector<double> &x, const std::vector<char> &still,
                     int max_blocks, RowPlan *plan);

/// Nodes whose three velocities are prescribed as 0, and which nobody watches.
std::vector<char> StillNodes(const Tables &tables);

}  // namespace cdem
