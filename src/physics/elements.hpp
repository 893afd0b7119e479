// The list of element forms, in the order of Shape.
#pragma once
#include "physics/element_hex.hpp"
#include "physics/element_tet.hpp"
#include "physics/element_wedge.hpp"

namespace cdem {

/// Calls f(Form{}) with the element form of that shape.
template <class F>
void VisitElement(Shape shape, F &&f) {
  switch (shape) {
    case Shape::kTet:
      f(TetFull{});
      break;
    case Shape::kWedge:
      f(WedgeFull{});
      break;
    case Shape::kHex:
      f(HexFull{});
      break;
  }
}

}  // namespace cdem
