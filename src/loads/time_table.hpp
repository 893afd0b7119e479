// Time tables: ramp, sine, Ricker and files of (time, value); table 0 is the constant 1.
#pragma once
#include "core/petsc.hpp"

#include <string>
#include <vector>

namespace cdem {

class Options;

struct TimeTable {
  enum Type { kConstant, kRamp, kSine, kRicker, kFile } type = kConstant;
  double frequency = 0, delay = 0, amplitude = 1;  ///< Hz, s, -
  std::vector<double> time, value;                 ///< of a file, ascending

  /// Value at time t [s].
  double At(double t) const;
};

/// Reads -tables and -table_<name>_*. names[0] is "" (the constant 1). Errors: an unknown type, a missing frequency or
/// file, a file whose times do not ascend (with its line).
PetscErrorCode ReadTables(Options &options, std::vector<std::string> *names, std::vector<TimeTable> *tables);

}  // namespace cdem
