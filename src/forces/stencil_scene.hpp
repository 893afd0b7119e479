// A scene as the plan of stencils sees it: which of its parts are alike, what acts on every node, where nodes stand.
#pragma once
#include "forces/stencil_classes.hpp"

#include <utility>

namespace cdem {

/// What acts on one node: a corner of an element, or an end of a spring.
struct Part {
  int table, row, corner;  ///< table: of the elements, then of the springs
};

struct StencilScene {
  const Tables &t;
  std::vector<AlikeElements> alike{};  ///< per table of elements, then of springs
  std::vector<std::size_t> start{};    ///< [node] of its parts
  std::vector<Part> part{};
  std::vector<int> place{};  ///< [node]
  std::vector<int> node{};   ///< [place]

  /// Fills the lists of parts; the others must be there.
  void ListParts();
  /// Places in the order of z, y, x, so that the nodes of a row follow each other.
  void ChoosePlaces();
  /// Places of the nodes that a node is coupled with, ascending.
  std::vector<int> Neighbours(int own) const;

  bool IsElement(const Part &p) const { return p.table < static_cast<int>(t.elements.size()); }
  const SpringTable &SpringsOf(const Part &p) const { return t.springs[p.table - t.elements.size()]; }
  /// The nodes that a part couples.
  template <class Visit>
  void Others(const Part &p, Visit &&visit) const {
    if (IsElement(p)) {
      const ElementTable &e = t.elements[p.table];
      for (int a = 0; a < e.corners; ++a) visit(e.Node(a, p.row));
    } else {
      const SpringTable &s = SpringsOf(p);
      visit(s.a[p.row]), visit(s.b[p.row]);
    }
  }

 private:
  std::vector<int> Kinds(const std::vector<std::pair<std::uint64_t, int>> &order) const;
};

}  // namespace cdem
