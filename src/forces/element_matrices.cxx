#include "forces/element_matrices.hpp"

#include "forces/bodies.hpp"
#include "forces/host_passes.hpp"
#include "forces/spring_body.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
namespace {

/// Some elements of a table, each with nodes and parameters of its own, so that one pass answers for all.
Tables Apart(const Tables &scene, const ElementTable &from, const std::vector<int> &elements) {
  Tables t;
  ElementTable some;
  some.shape = from.shape;
  some.form = from.form;
  some.law = from.law;
  some.corners = from.corners;
  some.n = static_cast<int>(elements.size());
  some.n_pad = Padded(some.n);
  some.node.resize(static_cast<std::size_t>(some.corners) * some.n_pad);
  for (std::vector<int> *of : {&some.material, &some.region, &some.cell}) of->assign(some.n_pad, 0);
  t.block_param.resize(static_cast<std::size_t>(kMaxParams) * some.n_pad);
  t.n_owned = t.n_local = some.corners * some.n_pad;
  t.x.resize(3 * static_cast<std::size_t>(t.n_local));
  for (int e = 0; e < some.n_pad; ++e) {
    const int of = elements[std::min(e, some.n - 1)];
    some.material[e] = e;
    std::copy_n(&scene.block_param[static_cast<std::size_t>(kMaxParams) * from.material[of]], kMaxParams,
                &t.block_param[static_cast<std::size_t>(kMaxParams) * e]);
    for (int a = 0; a < some.corners; ++a) {
      const int i = a * some.n_pad + e;
      some.node[i] = i;
      std::copy_n(&scene.x[3 * static_cast<std::size_t>(from.Node(a, of))], 3, &t.x[3 * static_cast<std::size_t>(i)]);
    }
  }
  t.elements = {std::move(some)};
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

std::array<double, 9> SpringMatrix(const SpringTable &t, int spring) {
  std::array<double, 9> matrix;
  for (int j = 0; j < 3; ++j) {
    Spring<double> s;
    double force[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      s.d[k] = k == j;
      s.normal[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + spring];
    }
    s.kn = t.kn[spring];
    s.ks = t.ks[spring];
    JointLaws::Visit(t.law, [&](auto law) {
      if constexpr (decltype(law)::kLinear) SpringForce<decltype(law), false>(s, force);
    });
    // force is what acts on end b when b has moved; the internal force is its opposite
    for (int i = 0; i < 3; ++i) matrix[3 * i + j] = -force[i];
  }
  return matrix;
}

}  // namespace cdem
