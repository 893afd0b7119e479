#include "forces/stencil_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cdem {

/// The parts of every node, in the order of tables and rows.
void StencilScene::ListParts() {
  start.assign(static_cast<std::size_t>(t.n_owned) + 1, 0);
  auto each = [&](auto &&f) {
    int table = 0;
    for (const ElementTable &e : t.elements) {
      for (int row = 0; row < e.n; ++row)
        for (int a = 0; a < e.corners; ++a) f(e.Node(a, row), Part{table, row, a});
      ++table;
    }
    for (const SpringTable &s : t.springs) {
      for (int row = 0; row < s.n; ++row) f(s.a[row], Part{table, row, 0}), f(s.b[row], Part{table, row, 1});
      ++table;
    }
  };
  each([&](int at, const Part &) { ++start[at + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  part.resize(start.back());
  std::vector<std::size_t> at(start.begin(), start.end() - 1);
  each([&](int own, const Part &p) { part[at[own]++] = p; });
}

/// Nodes at one point, which interfaces have split, lie in different parts of the order, by the side of their elements: so
/// that the nodes of one side follow each other. [in] order: coordinates as a number, node. Returns [node] kind.
std::vector<int> StencilScene::Kinds(const std::vector<std::pair<std::uint64_t, int>> &order) const {
  std::vector<int> kind(t.n_owned, 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!(i > 0 && order[i - 1].first == order[i].first) &&
        !(i + 1 < order.size() && order[i + 1].first == order[i].first))
      continue;
    const int own = order[i].second;
    double towards[3] = {0, 0, 0}, size = 0;
    for (std::size_t k = start[own]; k < start[own + 1]; ++k) {
      const Part &p = part[k];
      if (!IsElement(p)) continue;
      const ElementTable &e = t.elements[p.table];
      for (int a = 0; a < e.corners; ++a)
        for (int d = 0; d < 3; ++d) {
          const double there =
              t.x[3 * static_cast<std::size_t>(e.Node(a, p.row)) + d] - t.x[3 * static_cast<std::size_t>(own) + d];
          towards[d] += there;
          size += std::fabs(there);
        }
    }
    for (int d = 0; d < 3; ++d)
      kind[own] = 3 * kind[own] + (towards[d] > 1e-6 * size ? 1 : towards[d] < -1e-6 * size ? 2 : 0);
  }
  return kind;
}

void StencilScene::ChoosePlaces() {
  double low[3], extent = 0, size = 1e300;
  for (int d = 0; d < 3; ++d) {
    double least = 1e300, most = -1e300;
    for (int i = 0; i < t.n_owned; ++i) {
      least = std::min(least, t.x[3 * static_cast<std::size_t>(i) + d]);
      most = std::max(most, t.x[3 * static_cast<std::size_t>(i) + d]);
    }
    low[d] = least;
    extent = std::max(extent, most - least);
  }
  for (std::size_t table = 0; table < t.elements.size(); ++table) {
    const ElementTable &e = t.elements[table];
    for (int row : alike[table].first)
      for (int a = 1; a < e.corners; ++a) {
        double length2 = 0;
        for (int d = 0; d < 3; ++d)
          length2 += std::pow(t.x[3 * static_cast<std::size_t>(e.Node(a, row)) + d] -
                                  t.x[3 * static_cast<std::size_t>(e.Node(0, row)) + d],
                              2);
        size = std::min(size, std::sqrt(length2));
      }
  }
  constexpr std::uint64_t kMost = (1ull << 21) - 2;
  const double step = std::max(size / 64, extent / kMost);
  std::vector<std::pair<std::uint64_t, int>> order(t.n_owned);
  for (int i = 0; i < t.n_owned; ++i) {
    std::uint64_t key = 0;
    for (int d = 2; d >= 0; --d)
      key = key << 21 |
            static_cast<std::uint64_t>(std::floor((t.x[3 * static_cast<std::size_t>(i) + d] - low[d]) / step + 0.25));
    order[i] = {key, i};
  }
  std::sort(order.begin(), order.end());
  const std::vector<int> kind = Kinds(order);
  int count[28] = {};
  for (int k : kind) ++count[k + 1];
  std::partial_sum(count, count + 28, count);
  place.resize(t.n_owned);
  node.resize(t.n_owned);
  for (const auto &[key, own] : order) {
    place[own] = count[kind[own]]++;
    node[place[own]] = own;
  }
}

std::vector<int> StencilScene::Neighbours(int own) const {
  std::vector<int> places;
  for (std::size_t k = start[own]; k < start[own + 1]; ++k)
    Others(part[k], [&](int other) { places.push_back(place[other]); });
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace cdem
