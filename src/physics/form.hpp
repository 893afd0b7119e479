// What an element form is unless it says otherwise. A form is a plain struct with its name, shape, corners, points and
// the function Forces; it is named once in physics/elements.hpp.
#pragma once
#include "core/small.hpp"
#include "mesh/shapes.hpp"

#include <type_traits>

namespace cdem {

struct FormDefaults {
  static constexpr bool kAtCorners = false;  ///< its points are corners, and it gives laws their faces
  static constexpr bool kAverages = false;   ///< its dilatation is averaged over neighbours: forces/dilatation.hpp
  /// It stands for the form of the same name in the elements that it serves, those that are the image of the cube by a
  /// linear map, with linear laws.
  static constexpr bool kAffine = false;
};

/// Points that answer alike, linearly, and keep nothing.
template <class Point, class = void>
inline constexpr bool kUniform = false;
template <class Point>
inline constexpr bool kUniform<Point, std::enable_if_t<Point::kAlike>> = true;

/// Adds the same to the three normal components.
template <class T>
CDEM_HD void AddToDiagonal(T value, T s[6]) {
  s[kXX] += value;
  s[kYY] += value;
  s[kZZ] += value;
}

}  // namespace cdem
