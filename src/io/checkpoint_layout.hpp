// Names inside a checkpoint, for src/io/checkpoint*.cxx only. the user guide describes them.
#pragma once

namespace cdem::checkpoint {

constexpr char kTop[] = "CDEM", kType[] = "checkpoint";
constexpr int kVersion = 1;  ///< of the layout; a reader refuses a larger one
/// Numbers that every checkpoint has.
constexpr const char *kNumbers[] = {"step", "time", "dt", "safety", "dt_old", "run_dt", "base_step", "base_time"};

}  // namespace cdem::checkpoint
