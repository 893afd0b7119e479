#include "forces/bodies.hpp"
#include "forces/host_passes.hpp"
#include "forces/stencil.hpp"

#include <algorithm>

namespace cdem {
namespace {

/// Some elements of a table, each with nodes of its own, so that one pass answers for all.
Tables Apart(const Tables &scene, const ElementTable &from, const std::vector<int> &elements) {
  Tables t;
  ElementTable some;
  some.shape = from.shape;
  some.form = from.form;
  some.law = from.law;
  some.corners = from.corners;
  some.n = static_cast<int>(elements.size());
  some.n_pad = Padded(some.n);
  t.block_param = scene.block_param;
  t.n_owned = t.n_local = some.corners * some.n_pad;
  t.x.resize(3 * static_cast<std::size_t>(t.n_local));
  for (int a = 0; a < some.corners; ++a)
    for (int e = 0; e < some.n_pad; ++e) {
      const int node = static_cast<int>(some.node.size());
      some.node.push_back(node);
      std::copy_n(&scene.x[3 * static_cast<std::size_t>(from.Node(a, elements[std::min(e, some.n - 1)]))], 3,
                  &t.x[3 * static_cast<std::size_t>(node)]);
    }
  for (int e = 0; e < some.n_pad; ++e) {
    some.material.push_back(from.material[elements[std::min(e, some.n - 1)]]);
    some.region.push_back(from.region[elements[std::min(e, some.n - 1)]]);
  }
  for (int e = 0; e < some.n; ++e) some.cell.push_back(e);
  t.elements = {some};
  return t;
}

}  // namespace

std::vector<double> ElementMatrices(const Tables &scene, const ElementTable &table, const std::vector<int> &elements) {
  const int corners = table.corners;
  std::vector<double> matrix(9 * static_cast<std::size_t>(corners) * corners * elements.size());
  if (elements.empty()) return matrix;
  const Tables apart = Apart(scene, table, elements);
  const ElementTable &some = apart.elements[0];
  std::vector<ElementHistories> none = StartElements(apart);
  std::vector<double> u(apart.x.size()), f(apart.x.size());
  for (int b = 0; b < corners; ++b)
    for (int j = 0; j < 3; ++j) {
      std::fill(u.begin(), u.end(), 0.0);
      std::fill(f.begin(), f.end(), 0.0);
      for (int e = 0; e < some.n_pad; ++e) u[3 * static_cast<std::size_t>(some.Node(b, e)) + j] = 1;
      HostElements(apart, u.data(), nullptr, 0, 0, none, f.data());
      for (int e = 0; e < some.n; ++e)
        for (int a = 0; a < corners; ++a)
          for (int i = 0; i < 3; ++i)
            matrix[9 * ((static_cast<std::size_t>(e) * corners + a) * corners + b) + 3 * i + j] =
                f[3 * static_cast<std::size_t>(some.Node(a, e)) + i];
    }
  return matrix;
}

}  // namespace cdem
