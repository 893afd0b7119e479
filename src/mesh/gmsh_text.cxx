#include "mesh/gmsh_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <type_traits>

namespace cdem {

static bool IsSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

GmshText::GmshText(const std::string &path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) Fail("cannot be opened (" + error.message() + "): check the path");
  if (size == 0) Fail("is empty");
  bytes_.resize(size);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes_.data(), static_cast<std::streamsize>(size))) Fail("cannot be read: check its permissions");
  at_ = bytes_.data();
  end_ = at_ + bytes_.size();
}

void GmshText::ReadFormat() {
  std::string name;
  SkipSpace();
  const bool begins = at_ < end_ && *at_ == '$';
  if (!begins || !NextSection(&name) || name != "MeshFormat") {
    Fail("is not a gmsh .msh file of format 2.2 or 4.1 (it does not begin with $MeshFormat)");
  }
  const std::string line = Line();
  double version = 0;
  int binary = 0, size = 0, length = 0;
  if (std::sscanf(line.c_str(), "%lf %d %d%n", &version, &binary, &size, &length) != 3 ||
      line.c_str()[length] != '\0' || binary < 0 || binary > 1) {
    Fail("has a broken header: " + line.substr(0, 40));
  }
  version_ = version == 2.2 ? 22 : version == 4.1 ? 41 : 0;
  if (version_ == 0) {
    Fail("is of format " + line.substr(0, line.find(' ')) + "; save it as 4.1 or 2.2 (gmsh -format msh41)");
  }
  if (size != 8) Fail("is written with sizes of " + std::to_string(size) + " bytes; save it again with a current gmsh");
  binary_ = binary != 0;
  if (binary_ && Raw<std::int32_t>() != 1) Fail("is binary of another byte order: save it again here, or as ASCII");
  EndSection();
}

bool GmshText::NextSection(std::string *name) {
  SkipSpace();
  if (at_ >= end_) return false;
  std::string line = Line();
  if (line.empty() || line[0] != '$') Fail("is corrupt behind $End" + section_ + ": a $Section is expected");
  section_ = line.substr(1);
  *name = section_;
  return true;
}

void GmshText::SkipSection() {
  const std::size_t found = bytes_.find("$End" + section_, at_ - bytes_.data());
  if (found == std::string::npos) Truncated();
  at_ = bytes_.data() + found;
  Line();
}

void GmshText::EndSection() {
  SkipSpace();
  if (at_ >= end_) Truncated();
  const std::string line = Line(), wanted = "$End" + section_;
  if (line == wanted) return;
  if (at_ >= end_ && wanted.compare(0, line.size(), line) == 0) Truncated();
  Fail("is corrupt: $End" + section_ + " is expected where there is '" + line.substr(0, 40) + "'");
}

std::string GmshText::Line() {
  const char *stop = static_cast<const char *>(std::memchr(at_, '\n', end_ - at_));
  const char *next = stop ? stop + 1 : end_;
  if (!stop) stop = end_;
  while (stop > at_ && (stop[-1] == '\r' || stop[-1] == ' ')) --stop;
  std::string line(at_, stop);
  at_ = next;
  return line;
}

std::int64_t GmshText::LineInt() {
  const std::int64_t n = Parsed<std::int64_t>();
  while (at_ < end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
  const std::string rest = Line();
  if (!rest.empty()) Fail("is corrupt: '" + rest.substr(0, 40) + "' behind the number at the start of $" + section_);
  return n;
}

std::int64_t GmshText::Int() {
  if (binary_) return Raw<std::int32_t>();
  const std::int64_t n = Parsed<std::int64_t>();
  if (n != static_cast<std::int32_t>(n))
    Fail("holds a number beyond 32 bits in $" + section_ + ": " + std::to_string(n));
  return n;
}

void GmshText::CheckTotal(std::int64_t announced, std::int64_t there, const char *things) const {
  if (announced == there) return;
  Fail("is corrupt: $" + section_ + " announces " + std::to_string(announced) + " " + things + " and holds " +
       std::to_string(there));
}

std::int64_t GmshText::Count(std::int64_t n) const {
  if (n < 0 || n > end_ - at_) Truncated();
  return n;
}

void GmshText::SkipSpace() {
  while (at_ < end_ && IsSpace(*at_)) ++at_;
}

void GmshText::Truncated() const {
  Fail("ends inside $" + section_ + ": the file is truncated; write or copy it again");
}

template <class T>
T GmshText::Raw() {
  T value;
  if (end_ - at_ < static_cast<std::ptrdiff_t>(sizeof value)) Truncated();
  std::memcpy(&value, at_, sizeof value);
  at_ += sizeof value;
  return value;
}

template <class T>
T GmshText::Parsed() {
  T value;
  SkipSpace();
  if (at_ < end_ && *at_ == '+') ++at_;
  const std::from_chars_result result = std::from_chars(at_, end_, value);
  const bool ends = result.ptr == end_ || IsSpace(*result.ptr);  // not 1.5 for a whole number
  if (result.ec == std::errc::result_out_of_range && ends && std::is_floating_point_v<T>) {
    value = static_cast<T>(std::strtod(at_, nullptr));  // a denormal, say
  } else if (result.ec != std::errc() || !ends) {
    if (at_ >= end_ || *at_ == '$') Truncated();
    Fail("is corrupt: a number is expected in $" + section_ + " where there is '" +
         std::string(at_, std::min<std::ptrdiff_t>(end_ - at_, 20)) + "'");
  }
  at_ = result.ptr;
  return value;
}

template std::int32_t GmshText::Raw<std::int32_t>();
template std::int64_t GmshText::Raw<std::int64_t>();
template double GmshText::Raw<double>();
template std::int64_t GmshText::Parsed<std::int64_t>();
template double GmshText::Parsed<double>();

}  // namespace cdem
