#include "forces/host_gather.hpp"
#include "forces/host_passes.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

template <class Form, class Law, bool kBeta, bool kObserve>
void ElementLoop(const Tables &tables, const ElementTable &t, const double *u, const double *v, double beta, double *f,
                 int n_owned_cells, ElementResults *results) {
  constexpr int corners = Form::kCorners;
  const std::size_t stride = t.n_pad;
  for (int e = 0; e < t.n; e += kLanes) {
    Lanes x[corners][3], w[corners][3], force[corners][3], param[kMaxParams];
    for (int a = 0; a < corners; ++a) {
      const int *node = &t.node[a * stride + e];
      Gather(tables.x.data(), node, x[a]);
      Gather(u, node, w[a]);
      if (kBeta) {
        Lanes rate[3];
        Gather(v, node, rate);
        for (int k = 0; k < 3; ++k) w[a][k] += beta * rate[k];
      }
    }
    LoadParams(tables.block_param, &t.material[e], Law::kParams, param);
    ElementSums<Lanes> sums;
    ElementForce<Form, Law, kObserve>(x, w, param, force, &sums);

    alignas(sizeof(Lanes)) double out[corners][3][kLanes];
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k) Store(out[a][k], force[a][k]);
    const int live = std::min(kLanes, t.n - e);
    for (int l = 0; l < live; ++l) {
      CDEM_UNROLL for (int a = 0; a < corners; ++a) {
        double *to = f + 3 * static_cast<std::ptrdiff_t>(t.node[a * stride + e + l]);
        to[0] += out[a][0][l];
        to[1] += out[a][1][l];
        to[2] += out[a][2][l];
      }
      if (!kObserve) continue;
      const int cell = t.cell[e + l];
      if (cell >= n_owned_cells) continue;
      results->energy += sums.energy[l];
      results->force_count += 3 * corners;
      for (int a = 0; a < corners; ++a)
        for (int k = 0; k < 3; ++k) results->force_sum += std::fabs(out[a][k][l]);
      if (results->stress)
        for (int i = 0; i < 6; ++i)
          results->stress[6 * static_cast<std::ptrdiff_t>(cell) + i] = sums.stress[i][l] / sums.volume[l];
    }
  }
}

template <bool kBeta, bool kObserve>
void Elements(const Tables &tables, const double *u, const double *v, double beta, double *f, int n_owned_cells,
              ElementResults *results) {
  for (const ElementTable &t : tables.elements)
    VisitElement(t.shape, [&](auto form) {
      BlockLaws::Visit(t.law, [&](auto law) {
        ElementLoop<decltype(form), decltype(law), kBeta, kObserve>(tables, t, u, v, beta, f, n_owned_cells, results);
      });
    });
}

}  // namespace

void HostElements(const Tables &tables, const double *u, const double *v, double beta, double *f) {
  if (beta != 0)
    Elements<true, false>(tables, u, v, beta, f, 0, nullptr);
  else
    Elements<false, false>(tables, u, v, beta, f, 0, nullptr);
}

void HostElementsObserve(const Tables &tables, int n_owned_cells, const double *u, double *f, ElementResults *results) {
  Elements<false, true>(tables, u, nullptr, 0, f, n_owned_cells, results);
}

}  // namespace cdem
