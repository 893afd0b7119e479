#include "forces/stencil.hpp"

#include "forces/element_matrices.hpp"
#include "forces/rows.hpp"
#include "forces/stencil_scene.hpp"

#include <algorithm>

namespace cdem {
namespace {

constexpr int kOffsetNodes = 32;      ///< nodes from which on a class has offsets instead of a list
constexpr double kMostPadding = 1.5;  ///< positions a moving node

/// The scene, and what it is made of.
class Planner {
 public:
  Planner(const Tables &tables, int pad, bool any, StencilPlan *plan)
      : t_(tables), scene_{tables}, pad_(pad), any_(any), plan_(*plan), still_(StillNodes(tables)) {}

  std::string Plan();

 private:
  template <class Where>
  Sign128 SignOf(int node, Where &&where) const;
  void MakeClass(const std::vector<int> &nodes, bool listed);

  const Tables &t_;
  StencilScene scene_;
  const int pad_;
  const bool any_;
  StencilPlan &plan_;
  const std::vector<char> still_;
  std::vector<std::vector<double>> matrix_;  // per table of elements: of its classes
};

/// Equal for nodes with equal rows. [in] where: what tells a neighbour, of its place.
template <class Where>
Sign128 Planner::SignOf(int node, Where &&where) const {
  Sign128 sign;
  for (std::size_t k = scene_.start[node]; k < scene_.start[node + 1]; ++k) {
    const Part &p = scene_.part[k];
    Sign128 one;
    one.Add(static_cast<std::int64_t>(p.table) << 40 | static_cast<std::int64_t>(p.corner) << 32 |
            scene_.alike[p.table].of[p.row]);
    scene_.Others(p, [&](int other) { one.Add(where(scene_.place[other])); });
    sign.Join(one);
  }
  Sign128 own;
  own.Add(RelativeSteps(t_.inverse_mass[node]));
  own.Add(t_.records.n > 0 && t_.records.of_node[node] >= 0);
  sign.Join(own);
  return sign;
}

/// [in] nodes: with one row. listed: their neighbours are listed one by one.
void Planner::MakeClass(const std::vector<int> &nodes, bool listed) {
  StencilClass c;
  const int node = nodes[0], place = scene_.place[node];
  const std::vector<int> to = scene_.Neighbours(node);
  c.begin = static_cast<int>(plan_.position.size());
  c.first = static_cast<int>(plan_.entry.size());
  c.count = static_cast<int>(to.size());
  c.inverse_mass = t_.inverse_mass[node];
  c.records = t_.records.n > 0 && t_.records.of_node[node] >= 0;
  for (int other : to) plan_.entry.push_back({{0, 0, 0, 0, 0, 0, 0, 0, 0}, other - place});
  auto entry = [&](int other) {
    return plan_.entry[c.first + (std::lower_bound(to.begin(), to.end(), scene_.place[other]) - to.begin())].block;
  };
  for (std::size_t k = scene_.start[node]; k < scene_.start[node + 1]; ++k) {
    const Part &p = scene_.part[k];
    if (scene_.IsElement(p)) {
      const ElementTable &e = t_.elements[p.table];
      const double *matrix =
          &matrix_[p.table][9ull * e.corners *
                            (static_cast<std::size_t>(scene_.alike[p.table].of[p.row]) * e.corners + p.corner)];
      for (int b = 0; b < e.corners; ++b)
        for (int m = 0; m < 9; ++m) entry(e.Node(b, p.row))[m] += matrix[9 * b + m];
    } else {
      const SpringTable &s = scene_.SpringsOf(p);
      const std::array<double, 9> matrix = SpringMatrix(s, p.row);
      const int other = p.corner == 0 ? s.b[p.row] : s.a[p.row];
      for (int m = 0; m < 9; ++m) entry(node)[m] += matrix[m], entry(other)[m] -= matrix[m];
    }
  }
  std::vector<int> places;
  for (int i : nodes) places.push_back(scene_.place[i]);
  std::sort(places.begin(), places.end());
  if (listed) c.list = static_cast<std::int64_t>(plan_.list.size());
  plan_.moving += static_cast<int>(places.size());
  for (std::size_t tile = 0; tile < places.size(); tile += pad_) {
    const std::size_t end = std::min(places.size(), tile + pad_);
    plan_.position.insert(plan_.position.end(), places.begin() + tile, places.begin() + end);
    plan_.position.resize(plan_.position.size() + (tile + pad_ - end), -1);
    if (!listed) continue;
    const std::size_t at = plan_.list.size();
    plan_.list.resize(at + static_cast<std::size_t>(c.count) * pad_, 0);
    for (std::size_t i = tile; i < end; ++i) {
      const std::vector<int> far = scene_.Neighbours(scene_.node[places[i]]);
      for (int k = 0; k < c.count; ++k) plan_.list[at + static_cast<std::size_t>(k) * pad_ + (i - tile)] = far[k];
    }
  }
  c.end = static_cast<int>(plan_.position.size());
  plan_.classes.push_back(c);
}

std::string Planner::Plan() {
  for (const ElementTable &e : t_.elements) {
    constexpr int kSample = 1000;
    const AlikeElements some = FindAlike(t_, e, std::max(1, e.n / kSample));
    if (!any_ && 2 * some.first.size() > some.of.size() && some.of.size() > 8) return "few elements are alike";
    scene_.alike.push_back(FindAlike(t_, e));
    matrix_.push_back(ElementMatrices(t_, e, scene_.alike.back().first));
  }
  for (const SpringTable &s : t_.springs) scene_.alike.push_back(FindAlike(s));
  scene_.ListParts();
  scene_.ChoosePlaces();
  // by offsets where many nodes have them in common; the others by the ranks of their neighbours
  BySign<std::vector<int>> by_offset, by_rank;
  const auto moves = [&](int i) { return !still_[i] && scene_.start[i + 1] > scene_.start[i]; };
  for (int place = 0; place < t_.n_owned; ++place) {
    const int i = scene_.node[place];
    if (moves(i)) by_offset[SignOf(i, [&](int other) { return other - place; })].push_back(i);
  }
  std::vector<const std::vector<int> *> classes;
  for (const auto &[sign, nodes] : by_offset) {
    if (nodes.size() >= kOffsetNodes) {
      classes.push_back(&nodes);
      continue;
    }
    for (int i : nodes) {
      const std::vector<int> to = scene_.Neighbours(i);
      by_rank[SignOf(i, [&](int other) { return std::lower_bound(to.begin(), to.end(), other) - to.begin(); })]
          .push_back(i);
    }
  }
  const std::size_t offset_classes = classes.size();
  for (const auto &[sign, nodes] : by_rank) classes.push_back(&nodes);
  // in an order that does not depend on a hash table, and the counts before anything is made of them
  std::size_t positions = 0, moving = 0;
  for (const std::vector<int> *nodes : classes) {
    positions += (nodes->size() + pad_ - 1) / pad_ * pad_;
    moving += nodes->size();
  }
  if (moving == 0) return "nothing that moves";
  if (!any_ && static_cast<double>(positions) > kMostPadding * static_cast<double>(moving) + 64.0 * pad_)
    return "few nodes are alike";
  auto first = [](const std::vector<int> *nodes) { return *std::min_element(nodes->begin(), nodes->end()); };
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t c = 0; c < classes.size(); ++c) order.push_back({first(classes[c]), c});
  std::sort(order.begin(), order.end());
  for (const auto &[node, c] : order) {
    std::vector<int> nodes = *classes[c];
    std::sort(nodes.begin(), nodes.end());
    MakeClass(nodes, c >= offset_classes);
  }
  plan_.node = std::move(scene_.node);
  return "";
}

}  // namespace

std::string StencilText(const StencilPlan &plan) {
  return std::to_string(plan.classes.size()) + " rows of the stiffness for " + std::to_string(plan.moving) +
         " nodes: congruent elements";
}

std::string PlanStencil(const Tables &tables, int pad, bool any, StencilPlan *plan) {
  const std::string why = NoRows(tables);
  return why.empty() ? Planner(tables, pad, any, plan).Plan() : why;
}

}  // namespace cdem
