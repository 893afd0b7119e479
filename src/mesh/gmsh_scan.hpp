// One look through a gmsh file on one rank, before PETSc's reader has it: what PETSc accepts silently or stumbles over
// is found here, and what it throws away (names, lines and points, element numbers) is kept. Builds no mesh.
#pragma once
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

/// Something wrong with the file; what() completes the sentence "mesh 'file.msh': ...".
struct GmshError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// (dimension, positive tag) of a physical group.
using GmshKey = std::pair<int, int>;

struct GmshScan {
  bool multiple_tags = false;                            ///< format 4.1: an element may be in several groups
  std::map<GmshKey, std::string> names;                  ///< $PhysicalNames as they are
  std::map<GmshKey, std::int64_t> elements;              ///< groups with elements, and how many
  std::map<GmshKey, std::vector<std::int64_t>> corners;  ///< of lines (pairs) and points: vertices as PETSc counts them
  std::map<int, std::int64_t>
      surface_corners;                    ///< of surface groups: corners of their different elements, all together
  std::vector<std::int64_t> cell_number;  ///< the file's numbers of tetrahedra, hexahedra, wedges, in turn
  std::int64_t ungrouped = 0;             ///< volume elements in no group
  std::int64_t orphans = 0;               ///< nodes in no volume element
};

/// Reads formats 2.2 and 4.1, ASCII and binary. Throws GmshError.
GmshScan ScanGmsh(const std::string &path);

}  // namespace cdem
