// The numbers of a gmsh file one after another, whether they are written as text or in binary.
#pragma once
#include "mesh/gmsh_scan.hpp"

namespace cdem {

class GmshText {
 public:
  /// Reads the file into memory. Throws GmshError when that fails or it is empty.
  explicit GmshText(const std::string &path);
  /// The header: not a gmsh file, or another version than 2.2 and 4.1?
  void ReadFormat();
  int version() const { return version_; }  ///< 22 or 41
  bool binary() const { return binary_; }

  /// Goes to the next $Section; false at the end of the file.
  bool NextSection(std::string *name);
  void SkipSection();  ///< to behind $EndSection
  void EndSection();   ///< $EndSection must be next

  std::string Line();      ///< the rest of the line
  std::int64_t LineInt();  ///< a number on a line of its own, text in binary files too
  std::int64_t Int();      ///< of 32 bits, in text too
  std::int64_t Size() { return binary_ ? Raw<std::int64_t>() : Parsed<std::int64_t>(); }
  double Real() { return binary_ ? Raw<double>() : Parsed<double>(); }
  /// A number of things to come, each of at least a byte: checked against what is left of the file.
  std::int64_t Count(std::int64_t n) const;
  std::int64_t Count() { return Count(Size()); }
  /// An error unless so many things were announced as there are.
  void CheckTotal(std::int64_t announced, std::int64_t there, const char *things) const;

  [[noreturn]] void Fail(const std::string &what) const { throw GmshError(what); }

 private:
  template <class T>
  T Raw();
  template <class T>
  T Parsed();
  void SkipSpace();
  [[noreturn]] void Truncated() const;

  std::string bytes_, section_;
  const char *at_, *end_;
  int version_ = 0;
  bool binary_ = false;
};

}  // namespace cdem
