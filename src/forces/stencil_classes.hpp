// Which elements and springs of a scene are alike, for the plan of stencils.
#pragma once
#include "forces/tables.hpp"

#include <cmath>
#include <cstring>
#include <unordered_map>

namespace cdem {

/// A number that tells what went into it, of 128 bits: equal for equal things, different for all others but by an accident
/// of 1 in 2^128.
struct Sign128 {
  std::uint64_t a = 0x9e3779b97f4a7c15ull, b = 0xbf58476d1ce4e5b9ull;

  void Add(std::int64_t x) {
    a = Mixed(a ^ static_cast<std::uint64_t>(x), 0xff51afd7ed558ccdull);
    b = Mixed(b + static_cast<std::uint64_t>(x), 0x94d049bb133111ebull);
  }
  /// What was added before and after commutes.
  void Join(const Sign128 &o) {
    a += Mixed(o.a, 0xc4ceb9fe1a85ec53ull);
    b += Mixed(o.b, 0xd6e8feb86659fd93ull);
  }
  bool operator==(const Sign128 &o) const { return a == o.a && b == o.b; }

 private:
  static std::uint64_t Mixed(std::uint64_t x, std::uint64_t by) {
    x *= by;
    return x ^ x >> 32;
  }
};

struct SignHash {
  std::size_t operator()(const Sign128 &s) const { return s.a; }
};
template <class T>
using BySign = std::unordered_map<Sign128, T, SignHash>;

/// A length in steps of kCongruent sizes. [in] size: of the element, a power of two times a constant, so that rounding does
/// not change it from one element to the next. The shift keeps round numbers away from the edges of steps.
std::int64_t Steps(double x, double size);
/// A number in relative steps of kCongruent.
std::int64_t RelativeSteps(double x);

/// Classes of the elements of a table and of the springs of one.
struct AlikeElements {
  std::vector<int> of;     ///< [n] class
  std::vector<int> first;  ///< [class] an element of it
};
AlikeElements FindAlike(const Tables &tables, const ElementTable &table, int stride = 1);
AlikeElements FindAlike(const SpringTable &table);

}  // namespace cdem
