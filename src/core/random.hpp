// What the users of Random123 share. A random number is a function of the seed, a key that names what it is for, and a
// counter: the same on every rank and machine.
#pragma once
#include "core/host_device.hpp"

#include <cstdint>
#include <string_view>

namespace cdem {

/// FNV-1a: the same number for the same text on every machine.
inline std::uint64_t KeyNumber(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (unsigned char c : text) h = (h ^ c) * 0x100000001b3ULL;
  return h;
}

/// 53 random bits as a number from 0 to below 1.
CDEM_HD double UnitReal(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace cdem
