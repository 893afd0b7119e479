// What an element form is unless it says otherwise. A form is a plain struct with its name, shape, corners, points and
// the function Forces; it is named once in physics/elements.hpp.
#pragma once
#include "core/small.hpp"
#include "mesh/shapes.hpp"

namespace cdem {

struct FormDefaults {
  static constexpr bool kAtCorners = false;  ///< its points are corners, and it gives laws their faces
  static constexpr bool kAverages = false;   ///< its dilatation is averaged over neighbours: forces/dilatation.hpp
};

/// Adds the same to the three normal components.
template <class T>
CDEM_HD void AddToDiagonal(T value, T s[6]) {
  s[kXX] += value;
  s[kYY] += value;
  s[kZZ] += value;
}

}  // namespace cdem
