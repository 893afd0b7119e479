#include "mesh/gmsh_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace cdem {

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
  int binary = 0, size = 0;
  if (std::sscanf(line.c_str(), "%lf %d %d", &version, &binary, &size) != 3) Fail("has a broken header: " + line);
  version_ = static_cast<int>(10 * version + 0.5);
  if (version_ != 22 && version_ != 41) {
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
  Line();
  return n;
}

std::int64_t GmshText::Count(std::int64_t n) const {
  if (n < 0 || n > end_ - at_) Truncated();
  return n;
}

void GmshText::SkipSpace() {
  while (at_ < end_ && (*at_ == ' ' || (*at_ >= '\t' && *at_ <= '\r'))) ++at_;
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
  if (result.ec == std::errc::result_out_of_range) {  // a denormal, say: what strtod makes of it
    value = static_cast<T>(std::strtod(at_, nullptr));
  } else if (result.ec != std::errc()) {
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
