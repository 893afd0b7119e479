// The stiffness of a linear scene by nodes: first which nodes couple, from the tables; then the matrices of elements and
// springs, so many at a time that what they need stays in the caches.
#include "forces/element_matrices.hpp"
#include "forces/rows.hpp"

#include <algorithm>
#include <numeric>

namespace cdem {
namespace {

constexpr int kChunk = 512;  ///< elements at a time; a multiple of every padding

/// Which elements and springs each node has: [start[i], start[i + 1]) of item.
struct Stars {
  std::vector<std::size_t> start;
  std::vector<int> item;
};

/// [in] each: calls its argument (node, item) for every pair, in the same order each time.
template <class Each>
Stars StarsOf(int nodes, Each &&each) {
  Stars stars;
  stars.start.assign(static_cast<std::size_t>(nodes) + 2, 0);
  each([&](int node, int) { ++stars.start[static_cast<std::size_t>(node) + 2]; });
  for (std::size_t i = 2; i < stars.start.size(); ++i) stars.start[i] += stars.start[i - 1];
  stars.item.resize(stars.start.back());
  each([&](int node, int item) { stars.item[stars.start[static_cast<std::size_t>(node) + 1]++] = item; });
  stars.start.pop_back();
  return stars;
}

/// Rows without values: a node couples with those of its elements, and with the other ends of its springs.
StiffnessRows Couplings(const Tables &t) {
  std::vector<Stars> elements, springs;
  for (const ElementTable &table : t.elements)
    elements.push_back(StarsOf(t.n_owned, [&](auto &&add) {
      for (int e = 0; e < table.n; ++e)
        for (int a = 0; a < table.corners; ++a) add(table.Node(a, e), e);
    }));
  for (const SpringTable &table : t.springs)
    springs.push_back(StarsOf(t.n_owned, [&](auto &&add) {
      for (int i = 0; i < table.n; ++i) {
        add(table.a[i], i);
        add(table.b[i], i);
      }
    }));
  StiffnessRows rows;
  rows.start.assign(1, 0);
  rows.start.reserve(static_cast<std::size_t>(t.n_owned) + 1);
  std::vector<int> row;
  for (int i = 0; i < t.n_owned; ++i) {
    row.clear();
    for (std::size_t g = 0; g < elements.size(); ++g)
      for (std::size_t k = elements[g].start[i]; k < elements[g].start[i + 1]; ++k)
        for (int a = 0; a < t.elements[g].corners; ++a) row.push_back(t.elements[g].Node(a, elements[g].item[k]));
    for (std::size_t g = 0; g < springs.size(); ++g)
      for (std::size_t k = springs[g].start[i]; k < springs[g].start[i + 1]; ++k) {
        row.push_back(t.springs[g].a[springs[g].item[k]]);
        row.push_back(t.springs[g].b[springs[g].item[k]]);
      }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    rows.column.insert(rows.column.end(), row.begin(), row.end());
    rows.start.push_back(static_cast<int>(rows.column.size()));
  }
  rows.block.assign(9 * rows.column.size(), 0.0);
  return rows;
}

/// The block of a row and a column that couple.
double *BlockOf(StiffnessRows *rows, int row, int column) {
  const auto begin = rows->column.begin() + rows->start[row], end = rows->column.begin() + rows->start[row + 1];
  return &rows->block[9 * static_cast<std::size_t>(std::lower_bound(begin, end, column) - rows->column.begin())];
}

/// Adds elements [first, first + n).
void AddElements(const Tables &scene, const ElementTable &table, int first, int n, StiffnessRows *rows) {
  std::vector<int> elements(n);
  std::iota(elements.begin(), elements.end(), first);
  const std::vector<double> matrices = ElementMatrices(scene, table, elements);
  const double *from = matrices.data();
  for (int e = first; e < first + n; ++e)
    for (int a = 0; a < table.corners; ++a)
      for (int b = 0; b < table.corners; ++b, from += 9) {
        double *block = BlockOf(rows, table.Node(a, e), table.Node(b, e));
        for (int i = 0; i < 9; ++i) block[i] += from[i];
      }
}

void AddSprings(const SpringTable &t, StiffnessRows *rows) {
  for (int i = 0; i < t.n; ++i) {
    const std::array<double, 9> matrix = SpringMatrix(t, i);
    double *bb = BlockOf(rows, t.b[i], t.b[i]), *ba = BlockOf(rows, t.b[i], t.a[i]);
    double *ab = BlockOf(rows, t.a[i], t.b[i]), *aa = BlockOf(rows, t.a[i], t.a[i]);
    for (int k = 0; k < 9; ++k) {
      bb[k] += matrix[k];
      ba[k] -= matrix[k];
      ab[k] -= matrix[k];
      aa[k] += matrix[k];
    }
  }
}

}  // namespace

StiffnessRows AssembleRows(const Tables &tables) {
  StiffnessRows rows = Couplings(tables);
  for (const ElementTable &t : tables.elements)
    for (int first = 0; first < t.n; first += kChunk)
      AddElements(tables, t, first, std::min(kChunk, t.n - first), &rows);
  for (const SpringTable &t : tables.springs) AddSprings(t, &rows);
  return rows;
}

}  // namespace cdem
