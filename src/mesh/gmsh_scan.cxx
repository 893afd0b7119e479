#include "mesh/gmsh_scan.hpp"

#include "mesh/gmsh_elements.hpp"
#include "mesh/gmsh_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace cdem {

namespace {

class Scanner {
 public:
  explicit Scanner(const std::string &path) : text_(path) {}

  GmshScan Scan() {
    text_.ReadFormat();
    scan_.multiple_tags = text_.version() == 41;
    for (std::string section; !done_ && text_.NextSection(&section);) {
      if (section == "Comments") {
        text_.SkipSection();
        continue;
      }
      TakeTurn(section);
      if (section == "PhysicalNames") {
        ReadNames();
      } else if (section == "Entities") {
        ReadEntities();
      } else if (section == "Nodes") {
        text_.version() == 41 ? ReadNodes41() : ReadNodes22();
        IndexNodes();
      } else {
        text_.version() == 41 ? ReadElements41() : ReadElements22();
        done_ = true;
      }
      text_.EndSection();
    }
    if (!done_) text_.Fail("has no $Elements: the file is truncated, or there is no mesh in it; write it again");
    Finish();
    return std::move(scan_);
  }

 private:
  // PETSc's reader takes these sections in this order and stumbles over any other one before the elements.
  void TakeTurn(const std::string &section) {
    const std::vector<std::string> order =
        text_.version() == 41 ? std::vector<std::string>{"PhysicalNames", "Entities", "Nodes", "Elements"}
                              : std::vector<std::string>{"PhysicalNames", "Nodes", "Elements"};
    const std::size_t at = std::find(order.begin(), order.end(), section) - order.begin();
    std::string all = "$MeshFormat";
    for (const std::string &name : order) all += ", $" + name;
    if (at >= order.size() || at < turn_ || at > turn_ + (turn_ == 0)) {  // only names may be left out
      text_.Fail("has the section $" + section.substr(0, 40) +
                 " where it cannot be: up to the elements there must be " + all +
                 ", in this order; save it again with gmsh");
    }
    turn_ = at + 1;
  }

  void ReadNames() {
    const std::int64_t n = text_.Count(text_.LineInt());
    for (std::int64_t i = 0; i < n; ++i) {
      const std::string line = text_.Line();
      const std::size_t open = line.find('"'), close = line.rfind('"');
      int dim, tag, length = 0;
      if (std::sscanf(line.c_str(), "%d %d %n", &dim, &tag, &length) != 2 || open == close ||
          open != static_cast<std::size_t>(length) || close + 1 != line.size()) {
        text_.Fail("has a line in $PhysicalNames that is not 'dimension tag \"name\"': " + line);
      }
      scan_.names[{dim, std::abs(tag)}] = line.substr(open + 1, close - open - 1);
    }
  }

  void ReadEntities() {
    std::int64_t count[4];
    for (std::int64_t &n : count) n = text_.Count();
    for (int dim = 0; dim < 4; ++dim) {
      for (std::int64_t i = 0; i < count[dim]; ++i) {
        const int entity = static_cast<int>(text_.Int());
        for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) text_.Real();
        const auto [place, first] = entity_groups_.try_emplace({dim, entity});
        if (!first) text_.Fail("describes the " + EntityName(dim, entity) + " twice");
        std::vector<int> &groups = place->second;
        for (std::int64_t n = text_.Count(); n > 0; --n) groups.push_back(static_cast<int>(text_.Int()));
        if (dim == 0) continue;
        for (std::int64_t n = text_.Count(); n > 0; --n) text_.Int();
      }
    }
  }

  void ReadNodes22() {
    const std::int64_t n = text_.Count(text_.LineInt());
    nodes_.reserve(n);
    for (std::int64_t i = 0; i < n; ++i) {
      nodes_.push_back(text_.Int());
      ReadPoint(nodes_.back());
    }
  }

  void ReadNodes41() {
    const std::int64_t blocks = text_.Count(), n = text_.Count();
    text_.Size();
    text_.Size();
    nodes_.reserve(n);
    for (std::int64_t b = 0; b < blocks; ++b) {
      const int dim = static_cast<int>(text_.Int()), entity = static_cast<int>(text_.Int());
      if (entity_groups_.count({dim, entity}) == 0) {
        text_.Fail("has nodes in the " + EntityName(dim, entity) + ", which $Entities does not describe");
      }
      if (text_.Int()) text_.Fail("holds parametric coordinates: write it with Mesh.SaveParametric = 0");
      const std::int64_t in_block = text_.Count(), first = static_cast<std::int64_t>(nodes_.size());
      for (std::int64_t i = 0; i < in_block; ++i) nodes_.push_back(text_.Size());
      for (std::int64_t i = 0; i < in_block; ++i) ReadPoint(nodes_[first + i]);
    }
    text_.CheckTotal(n, static_cast<std::int64_t>(nodes_.size()), "nodes");
  }

  void ReadPoint(std::int64_t node) {
    for (char axis = 'x'; axis <= 'z'; ++axis) {
      if (!std::isfinite(text_.Real())) {
        text_.Fail("node " + std::to_string(node) + " has a coordinate " + axis + " that is not a finite number");
      }
    }
  }

  void IndexNodes() {
    if (nodes_.empty()) text_.Fail("holds no nodes");
    const auto [least, most] = std::minmax_element(nodes_.begin(), nodes_.end());
    first_node_ = *least;
    if (*least < 0 || *most > std::numeric_limits<std::int32_t>::max()) {
      text_.Fail("has a node " + std::to_string(*least < 0 ? *least : *most) +
                 "; numbers from 1 to 2147483647 are possible: renumber them (gmsh: Mesh.Renumber = 1)");
    }
    const std::int64_t range = *most - *least + 1;
    if (range > 100 * static_cast<std::int64_t>(nodes_.size()) + 10000000) {
      text_.Fail("node numbers run from " + std::to_string(*least) + " to " + std::to_string(*most) + " with " +
                 std::to_string(nodes_.size()) + " nodes: renumber them (gmsh: Mesh.Renumber = 1)");
    }
    index_.assign(range, -1);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      std::int64_t &index = index_[nodes_[i] - first_node_];
      if (index >= 0) text_.Fail("node " + std::to_string(nodes_[i]) + " is there twice: renumber the nodes");
      index = static_cast<std::int64_t>(i);
    }
    in_any_.assign(nodes_.size(), false);
    in_volume_.assign(nodes_.size(), false);
  }

  void ReadElements22() {
    const std::int64_t n = text_.Count(text_.LineInt());
    std::vector<int> groups;
    for (std::int64_t i = 0; i < n;) {
      std::int64_t number = text_.binary() ? 0 : text_.Int();
      const ElementType &type = FindType(text_, text_.Int());
      const std::int64_t in_block = text_.binary() ? text_.Int() : 1, tags = text_.Int();
      if (in_block < 1 || in_block > n - i) {
        text_.Fail("is corrupt: a block of " + std::to_string(in_block) + " elements where " + std::to_string(n - i) +
                   " are to come");
      }
      text_.Count(tags);
      for (std::int64_t k = 0; k < in_block; ++k, ++i) {
        if (text_.binary()) number = text_.Int();
        groups.clear();
        for (std::int64_t t = 0; t < tags; ++t) {
          const int tag = static_cast<int>(text_.Int());  // the first is the physical group, 0 for none
          if (t == 0 && tag != 0) groups.push_back(tag);
        }
        ReadElement(number, type, groups);
      }
    }
  }

  void ReadElements41() {
    const std::int64_t blocks = text_.Count(), n = text_.Count();
    std::int64_t there = 0;
    for (int i = 0; i < 2; ++i) text_.Size();
    for (std::int64_t b = 0; b < blocks; ++b) {
      const int dim = static_cast<int>(text_.Int()), entity = static_cast<int>(text_.Int());
      const ElementType &type = FindType(text_, text_.Int());
      const auto known = entity_groups_.find({dim, entity});
      if (dim != type.dim || known == entity_groups_.end()) {
        text_.Fail("has elements of gmsh type " + std::to_string(type.type) + " in the " + EntityName(dim, entity) +
                   (dim != type.dim ? ", which is of another dimension" : ", which $Entities does not describe"));
      }
      const std::vector<int> &groups = known->second;
      if (dim == 3 && groups.size() > 1) {
        text_.Fail("volume " + std::to_string(entity) + " is in " + std::to_string(groups.size()) +
                   " physical groups: a volume element needs exactly one");
      }
      for (std::int64_t k = text_.Count(); k > 0; --k, ++there) {
        const std::int64_t number = text_.Size();
        ReadElement(number, type, groups);
      }
    }
    text_.CheckTotal(n, there, "elements");
  }

  void ReadElement(std::int64_t number, const ElementType &type, const std::vector<int> &groups) {
    std::int64_t node[8];
    for (int k = 0; k < type.nodes; ++k) {
      const std::int64_t name = text_.version() == 41 ? text_.Size() : text_.Int(), at = name - first_node_;
      node[k] = at >= 0 && at < static_cast<std::int64_t>(index_.size()) ? index_[at] : -1;
      if (node[k] < 0) {
        text_.Fail("element " + std::to_string(number) + " uses node " + std::to_string(name) + ", which is not there");
      }
      for (int j = 0; j < k; ++j) {
        if (node[j] == node[k]) {
          text_.Fail("element " + std::to_string(number) + " uses node " + std::to_string(name) +
                     " twice: collapsed elements are not possible, use the shape that it has become");
        }
      }
      in_any_[node[k]] = true;
      if (type.dim == 3) in_volume_[node[k]] = true;
    }
    for (int tag : groups) {
      CheckTag(number, type.dim, tag);
      const GmshKey key{type.dim, std::abs(tag)};
      ++scan_.elements[key];
      if (type.dim < 2) scan_.corners[key].insert(scan_.corners[key].end(), node, node + type.nodes);
    }
    if (type.dim == 3) cells_[type.order].push_back(number);
    if (type.dim == 3 && groups.empty()) ++scan_.ungrouped;
    if (type.dim == 2) AddSurface(number, type, node, groups);
  }

  // A minus says that the group turns the surface round. PETSc's labels hold no -1, for they mean "nothing" by it.
  void CheckTag(std::int64_t number, int dim, int tag) const {
    if (tag == std::numeric_limits<std::int32_t>::min() || (tag < 0 && (dim == 3 || (dim == 2 && tag == -1)))) {
      text_.Fail("element " + std::to_string(number) + " is in the physical group " + std::to_string(tag) +
                 ": volumes need a tag above 0, and surfaces any but -1: number the groups anew");
    }
  }

  void AddSurface(std::int64_t number, const ElementType &type, const std::int64_t *node,
                  const std::vector<int> &groups) {
    std::array<std::int64_t, 4> corners{-1, -1, -1, -1};
    std::copy_n(node, type.nodes, corners.begin());
    std::sort(corners.begin(), corners.end());
    for (int tag : groups) surface_of_group_[std::abs(tag)].push_back(corners);
    surface_.emplace_back(number, corners);
  }

  void Finish() {
    for (const auto &part : cells_) scan_.cell_number.insert(scan_.cell_number.end(), part.begin(), part.end());
    if (scan_.cell_number.empty()) {
      text_.Fail(
          "holds no volume elements: mesh in three dimensions (gmsh -3), and if there are physical groups, put "
          "the volumes in one too, for gmsh saves nothing else then");
    }
    for (const auto &[number, corners] : surface_) {
      for (std::int64_t corner : corners) {
        if (corner < 0 || in_volume_[corner]) continue;
        text_.Fail("surface element " + std::to_string(number) + " hangs on node " + std::to_string(nodes_[corner]) +
                   ", which is no corner of a volume element: a surface must consist of faces of volume elements "
                   "(take it away, or embed it in the volume)");
      }
    }
    for (auto &[tag, faces] : surface_of_group_) {
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
      std::int64_t &corners = scan_.surface_corners[tag];
      for (const auto &face : faces) corners += face[0] < 0 ? 3 : 4;
    }
    scan_.orphans = std::count(in_volume_.begin(), in_volume_.end(), false);
    std::vector<std::int64_t> vertex(nodes_.size(), -1);  // PETSc makes vertices of the nodes that any element uses
    std::int64_t n = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) vertex[i] = in_any_[i] ? n++ : -1;
    for (auto &[key, list] : scan_.corners) {
      for (std::int64_t &node : list) node = vertex[node];
    }
  }

  GmshText text_;
  GmshScan scan_;
  bool done_ = false;
  std::size_t turn_ = 0;                                           // how many of the sections in their order are behind
  std::map<std::pair<int, int>, std::vector<int>> entity_groups_;  // format 4.1: (dimension, entity) -> groups
  std::vector<std::int64_t> nodes_;                                // numbers, in file order
  std::int64_t first_node_ = 0;
  std::vector<std::int64_t> index_;  // [number - first_node_] place in the file, -1
  std::vector<bool> in_any_, in_volume_;
  std::vector<std::int64_t> cells_[3];
  using Corners = std::array<std::int64_t, 4>;  // sorted nodes, -1 first for a triangle
  std::vector<std::pair<std::int64_t, Corners>> surface_;
  std::map<int, std::vector<Corners>> surface_of_group_;
};

}  // namespace

GmshScan ScanGmsh(const std::string &path) { return Scanner(path).Scan(); }

}  // namespace cdem
