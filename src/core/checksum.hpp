// Checksums of arrays that ranks hold in pieces: a sum over rows, each with its number, so that neither the order nor the
// partition is in it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace cdem {

/// Takes one more word into a checksum (the mixing of SplitMix64).
inline std::uint64_t MixBits(std::uint64_t h, std::uint64_t word) {
  h = (h ^ word) + 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31);
}

/// The same for a number; -0 and 0 are one.
inline std::uint64_t MixReal(std::uint64_t h, double value) {
  std::uint64_t word;
  value += 0.0;
  std::memcpy(&word, &value, sizeof word);
  return MixBits(h, word);
}

/// Sum over rows of an array whose first one has the number first. [in] key: what the array is.
inline std::uint64_t SumOfRows(std::uint64_t key, std::uint64_t first, std::size_t rows, std::size_t bytes_a_row,
                               const void *data) {
  const char *at = static_cast<const char *>(data);
  std::uint64_t sum = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    std::uint64_t h = MixBits(key, first + r);
    for (std::size_t left = bytes_a_row; left > 0;) {
      std::uint64_t word = 0;
      const std::size_t size = left < sizeof word ? left : sizeof word;
      std::memcpy(&word, at, size);
      h = MixBits(h, word);
      at += size;
      left -= size;
    }
    sum += h;
  }
  return sum;
}

}  // namespace cdem
