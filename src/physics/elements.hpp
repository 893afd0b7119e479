// The lists of element forms, by shape: a new form is its header and one name here.
#pragma once
#include "physics/element_hex.hpp"
#include "physics/element_hex_affine.hpp"
#include "physics/element_hex_bbar.hpp"
#include "physics/element_hex_onepoint.hpp"
#include "physics/element_hex_spring.hpp"
#include "physics/element_tet.hpp"
#include "physics/element_tet_bbar.hpp"
#include "physics/element_wedge.hpp"
#include "physics/laws.hpp"

namespace cdem {

using TetForms = LawList<TetFull, TetBbar>;
using WedgeForms = LawList<WedgeFull, WedgeBbar>;
using HexForms = LawList<HexFull, HexBbar, HexOnePoint, HexSpring, HexAffine>;

/// Calls f(List{}) with the forms of a shape.
template <class F>
void VisitForms(Shape shape, F &&f) {
  switch (shape) {
    case Shape::kTet:
      f(TetForms{});
      break;
    case Shape::kWedge:
      f(WedgeForms{});
      break;
    case Shape::kHex:
      f(HexForms{});
      break;
  }
}

/// Calls f(Form{}) with the element form of that shape and number.
template <class F>
void VisitElement(Shape shape, int form, F &&f) {
  VisitForms(shape, [&](auto forms) { decltype(forms)::Visit(form, f); });
}

/// A law can be computed in a form: laws of corners in forms of corners, the others in the other forms, only linear ones in
/// forms for elements that are images of the cube by a linear map.
template <class Form, class Law>
inline constexpr bool kFits = Form::kAtCorners == Law::kAtCorners && (Law::kLinear || !Form::kAffine);

/// Calls f(Form{}, Law{}) for those that fit together.
template <class F>
void VisitBlock(Shape shape, int form, int law, F &&f) {
  VisitElement(shape, form, [&](auto element) {
    using Form = decltype(element);
    BlockLaws::Visit(law, [&](auto block) {
      if constexpr (kFits<Form, decltype(block)>) f(Form{}, block);
    });
  });
}

}  // namespace cdem
