// What a law is made of, and lists of laws. A block law or an interface law is a plain struct in a header of its own,
// named once in physics/laws.hpp; host and device code, option reading and messages are folded from that list.
#pragma once
#include "core/host_device.hpp"
#include "core/small.hpp"

#include <array>
#include <limits>
#include <string>
#include <utility>

namespace cdem {

inline constexpr double kPropertyInf = std::numeric_limits<double>::infinity();
enum PropertyBounds { kPropertyOpen, kPropertyClosed };

/// A number that a law wants from the user: option key, unit, the interval it must lie in, and what it is.
struct Property {
  const char *key, *unit;
  double low, high;
  PropertyBounds bounds;
  const char *text = "";  ///< for -help

  bool Allows(double value) const {
    return bounds == kPropertyOpen ? low < value && value < high : low <= value && value <= high;
  }
};

inline constexpr int kMaxParams = 8;  ///< doubles a law may keep per material or interface

template <class... Laws>
struct LawList {
  static constexpr int kCount = sizeof...(Laws);

  /// Calls f(Law{}) for the law of that number.
  template <class F>
  static void Visit(int law, F &&f) {
    int i = 0;
    ((i++ == law ? (void)f(Laws{}) : (void)0), ...);
  }
  static int Find(const std::string &name) {
    int found = -1, i = 0;
    ((found = name == Laws::kName ? i : found, ++i), ...);
    return found;
  }
  static std::string Names() {
    std::string all;
    ((all += std::string(all.empty() ? "" : ", ") + Laws::kName), ...);
    return all;
  }
};

}  // namespace cdem
