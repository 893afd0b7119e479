// What a law is made of, and lists of laws. A block law or an interface law is a plain struct in a header of its own,
// named once in physics/laws.hpp; host and device code, option reading and messages are folded from that list.
#pragma once
#include "core/host_device.hpp"
#include "core/small.hpp"

#include <array>
#include <limits>
#include <string>
#include <type_traits>
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
  const char *fallback_text = "";  ///< for -help, where the number does not say it

  bool Allows(double value) const {
    return bounds == kPropertyOpen ? low < value && value < high : low <= value && value <= high;
  }
};

/// Strength that nothing reaches, small enough for its square to be a number [Pa].
inline constexpr double kUnreached = 1e100;

inline constexpr int kMaxParams = 16;  ///< doubles a law may keep per row of parameters

/// What a block law is unless it says otherwise. Every block law has lambda and mu as its first two parameters, derived
/// from young and poisson as its first two properties.
struct BlockLawDefaults {
  static constexpr bool kLinear = false;      ///< the forces are linear in u: beta damping acts on u + beta v for free
  static constexpr int kState = 0;            ///< doubles of history a Gauss point; all zero at the start
  static constexpr bool kJudgesMean = false;  ///< breaks by the element's mean stress
  static constexpr bool kAtCorners =
      false;  ///< for forms whose points are corners: given vectors along their faces' normals
  static constexpr int kPlasticShear = -1;   ///< which number of the history is the plastic shear strain; -1: none
  static constexpr bool kNeedsSize = false;  ///< parameters depend on the size of the element
  /// The first six numbers of the history are a strain that makes no stress: plastic strain, and with it what a body
  /// under stress from the start, or of another stiffness before, has to be measured from.
  static constexpr bool kCarriesOffset = false;
  /// Changes parameters so that nothing fails any more; what has failed stays as it is.
  static void MakeIntact(double *) {}
  /// What is wrong with a combination of properties, or an empty string.
  static std::string Check(const double *) { return {}; }
  /// What Derive changed in the properties, for the header of the run, or an empty string.
  static std::string Remark(const double *) { return {}; }
  /// Size of an element [m] up to which its strength falls no faster than its stress can.
  static double LargestCell(const double *) { return kPropertyInf; }
};

/// Elements of the law break, by their mean stress or at their corners.
template <class Law>
inline constexpr bool kBreaks = Law::kJudgesMean || Law::kAtCorners;

inline constexpr int kMaxSpringState = 8;  ///< doubles of history an interface law may keep per spring

/// What an interface law is unless it says otherwise. Laws may share a name (and then have the same properties): a scene
/// gets the first of them that serves its properties.
struct JointLawDefaults {
  static constexpr bool kLinear = false;
  static constexpr bool kHistory = true;          ///< has a state byte a spring
  static constexpr int kState = 0;                ///< doubles of history a spring; all zero at the start
  static constexpr bool kMayKeepTension = false;  ///< asks for keep_tension, its parameter kKeepTension
  static constexpr std::size_t kFromBlocks = 0;   ///< its first properties, strengths; not given: the weaker block's
  static constexpr int kDamage = -1;              ///< which number of the history is a damage from 0 to 1; -1: none
  /// The history holds a slip kSlip [3] and an opening kGap [m] that make no force: references of a spring that was under
  /// force from the start, or of another stiffness before.
  static constexpr bool kCarriesOffset = false;
  /// As for block laws.
  static void MakeIntact(double *) {}
  static bool Serves(const double *) { return true; }
  /// What is wrong with a combination of properties, or an empty string.
  static std::string Check(const double *) { return {}; }
  /// Changes properties that contradict each other; what was changed, or an empty string.
  static std::string Adjust(double *) { return {}; }
  /// What is wrong with the properties on a face of that stiffness [Pa/m], or an empty string.
  static std::string CheckFace(const double *, double, double) { return {}; }
  /// The largest cells beside the interface that resolve its failure [m]. [in] young: of the blocks [Pa].
  static double LargestCell(const double *, double) { return kPropertyInf; }
  /// Energy stored in a spring after an evaluation that gave this force: F_n^2 / 2 K_n + F_s^2 / 2 K_s [J].
  template <class Spring, class T>
  static CDEM_HD T Energy(const Spring &s, const T force[3]) {
    T along = Dot(s.normal, force);
    T shear2 = Dot(force, force) - along * along;
    return 0.5 * (along * along / s.kn + shear2 / s.ks);
  }
};

template <class... Laws>
struct LawList {
  static constexpr int kCount = sizeof...(Laws);

  /// The number of a law.
  template <class Law>
  static constexpr int Number() {
    int number = -1, i = 0;
    ((number = std::is_same_v<Law, Laws> ? i : number, ++i), ...);
    return number;
  }

  /// Calls f(Law{}) for the law of that number.
  template <class F>
  static void Visit(int law, F &&f) {
    int i = 0;
    ((i++ == law ? (void)f(Laws{}) : (void)0), ...);
  }
  /// The first law of that name, -1 if there is none.
  static int Find(const std::string &name) {
    int found = -1, i = 0;
    ((found = found < 0 && name == Laws::kName ? i : found, ++i), ...);
    return found;
  }
  /// The first law of the same name that serves these properties.
  static int Choose(int law, const double *property) {
    std::string name;
    Visit(law, [&](auto l) { name = decltype(l)::kName; });
    int found = -1, i = 0;
    ((found = found < 0 && name == Laws::kName && Laws::Serves(property) ? i : found, ++i), ...);
    return found < 0 ? law : found;
  }
  /// The law of the same name that carries an offset; -1: none does.
  static int Carrier(int law) {
    std::string name;
    Visit(law, [&](auto l) { name = decltype(l)::kName; });
    int found = -1, i = 0;
    ((found = found < 0 && name == Laws::kName && Laws::kCarriesOffset ? i : found, ++i), ...);
    return found;
  }
  static std::string Names() {
    std::string all;
    int i = 0;
    ((all += Find(Laws::kName) == i++ ? std::string(all.empty() ? "" : ", ") + Laws::kName : std::string()), ...);
    return all;
  }
};

}  // namespace cdem
