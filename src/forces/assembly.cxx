// The stiffness of a linear scene by nodes: first which nodes couple, from the tables; then the matrices of elements and
// springs, so many at a time that what they need stays in the caches.
#include "forces/bodies.hpp"
#include "forces/host_passes.hpp"
#include "forces/rows.hpp"

#include <algorithm>
#include <utility>

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

/// Elements [first, first + n) of a table with nodes of their own each, so that one pass answers for all.
Tables Apart(const Tables &scene, const ElementTable &from, int first, int n) {
  Tables t;
  ElementTable part;
  part.shape = from.shape;
  part.form = from.form;
  part.law = from.law;
  part.corners = from.corners;
  part.n = n;
  part.n_pad = (n + 7) / 8 * 8;
  part.node.resize(static_cast<std::size_t>(part.corners) * part.n_pad);
  for (std::vector<int> *of : {&part.material, &part.region, &part.cell}) of->assign(part.n_pad, 0);
  t.block_param.resize(static_cast<std::size_t>(kMaxParams) * part.n_pad);
  t.n_owned = t.n_local = part.corners * part.n_pad;
  t.x.resize(3 * static_cast<std::size_t>(t.n_local));
  for (int e = 0; e < part.n_pad; ++e) {
    const int of = first + std::min(e, n - 1);
    part.material[e] = e;
    std::copy_n(&scene.block_param[static_cast<std::size_t>(kMaxParams) * from.material[of]], kMaxParams,
                &t.block_param[static_cast<std::size_t>(kMaxParams) * e]);
    for (int a = 0; a < part.corners; ++a) {
      const int i = a * part.n_pad + e;
      part.node[i] = i;
      std::copy_n(&scene.x[3 * static_cast<std::size_t>(from.Node(a, of))], 3, &t.x[3 * static_cast<std::size_t>(i)]);
    }
  }
  t.elements = {std::move(part)};
  return t;
}

/// Adds elements [first, first + n): the columns of their matrices are their forces on unit displacements.
void AddElements(const Tables &scene, const ElementTable &table, int first, int n, StiffnessRows *rows) {
  const Tables apart = Apart(scene, table, first, n);
  const int corners = table.corners, pad = apart.elements[0].n_pad;
  const std::size_t size = apart.x.size();
  std::vector<ElementHistories> none = StartElements(apart);
  std::vector<double> u(size), columns(3 * corners * size, 0.0);
  for (int b = 0; b < corners; ++b)
    for (int j = 0; j < 3; ++j) {
      for (int e = 0; e < pad; ++e) u[3 * (static_cast<std::size_t>(b) * pad + e) + j] = 1;
      HostElements(apart, u.data(), nullptr, 0, 0, none, &columns[(3 * b + j) * size]);
      for (int e = 0; e < pad; ++e) u[3 * (static_cast<std::size_t>(b) * pad + e) + j] = 0;
    }
  for (int e = 0; e < n; ++e)
    for (int a = 0; a < corners; ++a)
      for (int b = 0; b < corners; ++b) {
        double *block = BlockOf(rows, table.Node(a, first + e), table.Node(b, first + e));
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            block[3 * i + j] += columns[(3 * b + j) * size + 3 * (static_cast<std::size_t>(a) * pad + e) + i];
      }
}

void AddSprings(const SpringTable &t, StiffnessRows *rows) {
  const std::size_t stride = t.n_pad;
  for (int i = 0; i < t.n; ++i) {
    double *bb = BlockOf(rows, t.b[i], t.b[i]), *ba = BlockOf(rows, t.b[i], t.a[i]);
    double *ab = BlockOf(rows, t.a[i], t.b[i]), *aa = BlockOf(rows, t.a[i], t.a[i]);
    for (int j = 0; j < 3; ++j) {
      Spring<double> s;
      double force[3] = {0, 0, 0};
      for (int k = 0; k < 3; ++k) {
        s.d[k] = k == j;
        s.normal[k] = t.normal[k * stride + i];
      }
      s.kn = t.kn[i];
      s.ks = t.ks[i];
      JointLaws::Visit(t.law, [&](auto law) {
        if constexpr (decltype(law)::kLinear) SpringForce<decltype(law), false>(s, force);
      });
      // force is what acts on b when b has moved; the internal force is its opposite
      for (int k = 0; k < 3; ++k) {
        bb[3 * k + j] -= force[k];
        ba[3 * k + j] += force[k];
        ab[3 * k + j] += force[k];
        aa[3 * k + j] -= force[k];
      }
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
