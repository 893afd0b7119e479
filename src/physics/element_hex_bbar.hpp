// The 8-node hexahedron with 2x2x2 Gauss points and mean dilatation: the strain of every point has the dilatation of the
// element's mean, and so only one pressure acts. Arithmetic and scales are those of HexFull.
#pragma once
#include "physics/element_hex.hpp"
#include "physics/hex_volume.hpp"

namespace cdem {

struct HexBbar : FormDefaults {
  static constexpr const char *kName = "bbar";
  static constexpr Shape kShape = Shape::kHex;
  static constexpr int kCorners = 8;
  static constexpr int kPoints = 8;

  /// Internal forces f [8][3] [N] of displacements u [8][3] [m] at corners x [8][3] [m]; point as for HexFull.
  template <class T, class Point>
  static CDEM_HD void Forces(const T x[8][3], const T u[8][3], const Point &point, T f[8][3]) {
    T jx[4][3], je[4][3], jz[4][3], ux[4][3], ue[4][3], uz[4][3];
    T mean[6][3], dilatation;  // the mean of grad N by modes, and of div u
    {
      T m[7][3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(x, k, m);
      HexFull::Columns(m, 0, 3, 5, jx);
      HexFull::Columns(m, 1, 3, 4, je);
      HexFull::Columns(m, 2, 5, 4, jz);
      T scale = 1.0 / HexVolume<T>(m).Gradient(1.0 / 3.0, mean);
      CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) mean[i][k] *= scale;
    }
    {
      T m[7][3];
      CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::Modes(u, k, m);
      HexFull::Columns(m, 0, 3, 5, ux);
      HexFull::Columns(m, 1, 3, 4, ue);
      HexFull::Columns(m, 2, 5, 4, uz);
      dilatation = Dot(m[0], mean[0]);
      CDEM_UNROLL for (int i = 1; i < 6; ++i) dilatation += Dot(m[i], mean[i]);
    }
    T px[4][3] = {}, pe[4][3] = {}, pz[4][3] = {}, pressure{};
    CDEM_UNROLL for (int g = 0; g < 8; ++g) {
      const int xi = g & 1, eta = (g >> 1) & 1, zeta = g >> 2;
      const int a = eta + 2 * zeta, b = xi + 2 * zeta, c = xi + 2 * eta;
      T ca[3], cb[3], cc[3], strain[6], stress[6];
      Cross(je[b], jz[c], ca);
      Cross(jz[c], jx[a], cb);
      Cross(jx[a], je[b], cc);
      T det = Dot(jx[a], ca);
      StrainOf(ux[a], ue[b], uz[c], ca, cb, cc, 1.0 / det, strain);
      AddToDiagonal((dilatation - (strain[kXX] + strain[kYY] + strain[kZZ])) * (1.0 / 3.0), strain);
      point(g, strain, det * (1.0 / 512.0), stress);
      T p = (stress[kXX] + stress[kYY] + stress[kZZ]) * (1.0 / 3.0);
      pressure += det * p;
      AddToDiagonal(-p, stress);
      ApplyAdd(stress, ca, px[a]);
      ApplyAdd(stress, cb, pe[b]);
      ApplyAdd(stress, cc, pz[c]);
    }
    T m[7][3] = {};
    CDEM_UNROLL for (int i = 0; i < 6; ++i) CDEM_UNROLL for (int k = 0; k < 3; ++k) m[i][k] = pressure * mean[i][k];
    HexFull::ColumnsBack(px, 0, 3, 5, m);
    HexFull::ColumnsBack(pe, 1, 3, 4, m);
    HexFull::ColumnsBack(pz, 2, 5, 4, m);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) HexFull::FromModes(m, k, 1.0 / 512.0, f);
  }
};

}  // namespace cdem
