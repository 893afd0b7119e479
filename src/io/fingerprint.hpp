// What a scene is, in a few numbers that do not depend on the ranks: by them a checkpoint knows its scene.
#pragma once
#include "forces/tables.hpp"
#include "loads/time_table.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

/// Counts first, then checksums of everything that a step reads: what it is, and the number.
using Fingerprint = std::vector<std::pair<std::string, std::int64_t>>;

/// Takes it from the finished tables (collective). Histories of nodes (what is watched) are not in it.
PetscErrorCode TakeFingerprint(const Mesh &mesh, const Nodes &nodes, const std::vector<int> &face_interface,
                               const Tables &tables, const std::vector<TimeTable> &time_tables,
                               Fingerprint *fingerprint);

/// Checksum of time tables.
std::uint64_t OfTables(const std::vector<TimeTable> &tables);

/// What of it differs: "other coordinates of the mesh", "60 elements, and 75 now", or "".
std::string FingerprintDifference(const Fingerprint &was, const Fingerprint &now);

}  // namespace cdem
