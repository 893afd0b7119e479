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

inline constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();

/// A number that a law wants from the user: option key, unit, the interval it must lie in, what it is, and its value
/// when not given (kRequired: it must be). With words ("outer,middle"), the user gives one of them and the law gets its
/// place in the list.
struct Property {
  const char *key, *unit;
  double low, high;
  PropertyBounds bounds;
  const char *text = "";  ///< for -help
  double fallback = kRequired;
  const char *words = "";

  bool Allows(double value) const {
    return bounds == kPropertyOpen ? low < value && value < high : low <= value && value <= high;
  }
};

inline constexpr int kMaxParams = 16;  ///< doubles a law may keep per row of parameters

/// What a block law is unless it says otherwise. Every block law has lambda and mu as its first two parameters, derived
/// from young and poisson as its first two properties.
struct BlockLawDefaults {
  static constexpr bool kLinear = false;      ///< the forces are linear in u: beta damping acts on u + beta v for free
  static constexpr int kState = 0;            ///< doubles of history a Gauss point; all zero at the start
  static constexpr bool kJudgesMean = false;  ///< breaks by the element's mean stress
  static constexpr bool kAtCorners = false;   ///< for forms whose points are corners: given their face normals
  static constexpr bool kNeedsSize = false;   ///< parameters depend on the size of the element
  /// What is wrong with a combination of properties, or an empty string.
  static std::string Check(const double *) { return {}; }
};

/// What an interface law is unless it says otherwise.
struct JointLawDefaults {
  static constexpr bool kLinear = false;
  static constexpr bool kHistory = true;  ///< has a state byte and a slip per spring
  static std::string Check(const double *) { return {}; }
};

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
