#include "io/result_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace cdem {

static bool EndsWith(const std::string &name, const std::string &end) {
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

long long NumberIn(const std::string &name, const std::string &end, std::string *head) {
  if (!EndsWith(name, end)) return -1;
  const std::string stem = name.substr(0, name.size() - end.size());
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos || at + 1 == stem.size() || stem.size() - at > 19) return -1;
  const auto digits = stem.begin() + static_cast<std::ptrdiff_t>(at + 1);
  if (!std::all_of(digits, stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) return -1;
  *head = stem.substr(0, at);
  return std::atoll(stem.c_str() + at + 1);
}

bool IsResult(const std::string &name) {
  std::string head;
  if (name == "summary.json" || name == "histories.csv" || name == "joints.csv" || EndsWith(name, ".hdf.series"))
    return true;
  if (NumberIn(name, ".hdf", &head) >= 0) return true;
  return NumberIn(name, ".h5", &head) >= 0 && (EndsWith(head, "_mesh") || head == "checkpoint");
}

bool IsLeftover(const std::string &name) {
  if (!EndsWith(name, ".part")) return false;
  const std::string whole = name.substr(0, name.size() - 5);
  return IsResult(whole) || whole == "scene.opts";
}

}  // namespace cdem
