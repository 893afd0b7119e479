// A linear scene of many congruent elements as stencils: nodes whose rows of the stiffness are alike share one.
#pragma once
#include "forces/tables.hpp"

#include <string>

namespace cdem {

/// How far the shapes of congruent elements may be apart, in sizes of the element; numbers of springs and masses, relative.
inline constexpr double kCongruent = 1e-10;

/// A block of a row of the stiffness: what one neighbour's displacement does to the node.
struct alignas(16) StencilEntry {
  double block[9];      ///< N/m, force component first
  std::int64_t offset;  ///< place of the neighbour minus that of the node; used where the class has no list
};

/// Nodes with one row. They stand at positions [begin, end) of the plan, padded with -1.
struct StencilClass {
  int begin = 0, end = 0;
  int first = 0, count = 0;  ///< its entries
  std::int64_t list = -1;    ///< where its neighbours begin in StencilPlan::list; -1: they stand at place + offset
  double inverse_mass = 0;   ///< 1/kg
  bool records = false;      ///< its nodes have records
};

/// The nodes in an order of their own, their places: along the rows of a structured mesh, so that neighbours are found by
/// offsets, and apart by side where interfaces split them.
struct StencilPlan {
  std::vector<int> node;      ///< [place] local node
  std::vector<int> position;  ///< place of the node that moves there, ascending in a class; -1: padding
  std::vector<StencilClass> classes;
  std::vector<StencilEntry> entry;  ///< ascending in the neighbour's place
  std::vector<int> list;            ///< of a class: [tile of pad positions][entry][pad] places of neighbours
  int moving = 0;                   ///< nodes at positions
};

/// Plans the stencils of a scene. [in] pad: positions of a class are a multiple of it; any: even where little is alike.
/// Returns why the scene has none, or nothing. Nodes that stand still have places, but no position.
std::string PlanStencil(const Tables &tables, int pad, bool any, StencilPlan *plan);

/// "stencils of 27 nodes' rows for 1,331 nodes" for the header.
std::string StencilText(const StencilPlan &plan);

}  // namespace cdem
