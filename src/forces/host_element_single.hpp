// The loop over elastic elements on the CPU in single precision: positions and displacements relative to an element's
// first corner are rounded, so that what a body moves as a whole costs no digits; forces are added up in double precision.
#pragma once
#include "core/single.hpp"
#include "forces/host_element_loop.hpp"
#include "forces/single_check.hpp"

namespace cdem {

/// Forces of the elements of a table, which are added to pass.f.
template <class Form, bool kBeta>
void SingleLoop(const ElementPass &pass, const ElementTable &t) {
  constexpr int corners = Form::kCorners;
  const std::size_t stride = t.n_pad;
  for (int e = 0; e < t.n; e += kSingleLanes) {
    const int start[2] = {e,
                          std::min(e + kLanes, t.n_pad - kLanes)};  // no lanes beyond the end; those there are not used
    SingleLanes x[corners][3], w[corners][3], force[corners][3], param[kMaxParams];
    Lanes from[2][2][3], at[2][2][3], p[2][kMaxParams];  // of both halves: x and w of the first corner, of a corner
    for (int a = 0; a < corners; ++a) {
      for (int half = 0; half < 2; ++half) {
        const int *node = &t.node[a * stride + start[half]];
        Gather(pass.tables.x.data(), node, at[half][0]);
        Gather(pass.u, node, at[half][1]);
        if (kBeta) {
          Lanes v[3];
          Gather(pass.v, node, v);
          for (int k = 0; k < 3; ++k) at[half][1][k] += pass.beta * v[k];
        }
        for (int q = 0; a == 0 && q < 2; ++q)
          for (int k = 0; k < 3; ++k) from[half][q][k] = at[half][q][k];
      }
      for (int k = 0; k < 3; ++k) {
        x[a][k] = Rounded(at[0][0][k] - from[0][0][k], at[1][0][k] - from[1][0][k]);
        w[a][k] = Rounded(at[0][1][k] - from[0][1][k], at[1][1][k] - from[1][1][k]);
      }
    }
    for (int half = 0; half < 2; ++half)
      LoadParams(pass.tables.block_param, &t.material[start[half]], Elastic::kParams, p[half]);
    for (int i = 0; i < Elastic::kParams; ++i) param[i] = Rounded(p[0][i], p[1][i]);
    ElementForce<Form, Elastic, false, SingleLanes>(x, w, param, force, nullptr);
    alignas(64) float out[corners][3][kSingleLanes];
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k) __builtin_memcpy(out[a][k], &force[a][k].v, sizeof out[a][k]);
    const int live = std::min(kSingleLanes, t.n - e);
    for (int l = 0; l < live; ++l) CDEM_UNROLL for (int a = 0; a < corners; ++a) {
        double *to = pass.f + 3 * static_cast<std::ptrdiff_t>(t.node[a * stride + e + l]);
        for (int k = 0; k < 3; ++k) to[k] += static_cast<double>(out[a][k][l]);
      }
  }
}

}  // namespace cdem
