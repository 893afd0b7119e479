// Files that a kill or a full disk never leaves half written, and a failure on one rank told to all.
#pragma once
#include "core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace cdem {

/// Replaces path by text: path.part is written and renamed. Returns what went wrong, or "".
inline std::string ReplaceFile(const std::string &path, const std::string &text) {
  const std::string part = path + ".part";
  std::FILE *file = std::fopen(part.c_str(), "wb");
  if (!file) return "cannot write " + part + ": " + std::strerror(errno);
  bool good = std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  int code = errno;
  if (std::fclose(file) != 0 && good) {
    good = false;
    code = errno;
  }
  if (good && std::rename(part.c_str(), path.c_str()) == 0) return "";
  if (good) code = errno;
  std::remove(part.c_str());
  return "cannot write " + path + ": " + std::strerror(code);
}

}  // namespace cdem
