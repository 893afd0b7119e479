#include "forces/references.hpp"

#include "mesh/geometry.hpp"
#include "physics/elements.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

/// The stress of a material at a height [Pa].
void StressAt(const Material &m, double z, double stress[6]) {
  for (int i = 0; i < 6; ++i) stress[i] = m.stressed ? m.stress[i] + m.gradient[i] * z : 0;
}

/// Height of point g of a form [m]. Forms with one point have it at the mean of their corners.
template <class Form>
double PointHeight(const double (*x)[3], int g) {
  double z = 0;
  if constexpr (Form::kPoints == 1) {
    for (int a = 0; a < Form::kCorners; ++a) z += x[a][2] / Form::kCorners;
  } else if constexpr (Form::kShape == Shape::kHex) {
    static const int side[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
    const double at[3] = {g & 1 ? HexFull::kGauss : -HexFull::kGauss, g & 2 ? HexFull::kGauss : -HexFull::kGauss,
                          g & 4 ? HexFull::kGauss : -HexFull::kGauss};
    for (int a = 0; a < 8; ++a)
      z += (1 + side[a][0] * at[0]) * (1 + side[a][1] * at[1]) * (1 + side[a][2] * at[2]) / 8 * x[a][2];
  } else {
    const WedgeFull::Weights w(g);
    const double l[3] = {w.l0, w.l1, w.l2};
    for (int a = 0; a < 3; ++a) z += l[a] * (w.bottom * x[a][2] + w.top * x[a + 3][2]);
  }
  return z;
}

/// Instead of a law: gives stresses, and keeps strains.
struct PointTable {
  const double (*stress)[6];  ///< NULL: none
  double (*strain)[6];        ///< NULL: not wanted

  void operator()(int g, const double of_u[6], double, double out[6]) const {
    for (int i = 0; i < 6; ++i) out[i] = stress ? stress[g][i] : 0;
    if (strain) std::copy_n(of_u, 6, strain[g]);
  }
  void operator()(int g, const double of_u[6], double volume, const double (*)[3], double out[6]) const {
    (*this)(g, of_u, volume, out);
  }
  double ShearModulus() const { return 0; }
  void Stored(double) const {}
};

/// Solves a w = b for a symmetric, positive definite matrix (Cholesky's factors, in place).
template <int n>
void SolveDense(double (*a)[n], const double *b, double *w) {
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    a[j][j] = std::sqrt(a[j][j]);
    for (int i = j + 1; i < n; ++i) {
      for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  for (int i = 0; i < n; ++i) {
    w[i] = b[i];
    for (int k = 0; k < i; ++k) w[i] -= a[i][k] * w[k];
    w[i] /= a[i][i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) w[i] -= a[k][i] * w[k];
    w[i] /= a[i][i];
  }
}

/// Displacements that a free elastic element of this form takes under forces in balance; rigid ones are held.
template <class Form>
void FreeDisplacements(const double (*x)[3], const double *param, const double *force, double *w) {
  constexpr int corners = Form::kCorners, n = 3 * corners;
  double a[n][n], u[corners][3] = {}, f[corners][3], stiffness = 0;
  for (int j = 0; j < n; ++j) {
    u[j / 3][j % 3] = 1;
    ElementForce<Form, Elastic, false, double>(x, u, param, f, nullptr);
    u[j / 3][j % 3] = 0;
    for (int i = 0; i < n; ++i) a[i][j] = f[i / 3][i % 3];
    stiffness += a[j][j] / n;
  }
  double centre[3] = {0, 0, 0};
  for (int c = 0; c < corners; ++c)
    for (int k = 0; k < 3; ++k) centre[k] += x[c][k] / corners;
  for (int mode = 0; mode < 6; ++mode) {  // makes what a rigid motion would cost as stiff as the rest
    double r[n] = {}, length2 = 0;
    for (int c = 0; c < corners; ++c) {
      const int p = mode % 3, q = (mode + 1) % 3;
      if (mode < 3) {
        r[3 * c + p] = 1;
      } else {
        r[3 * c + p] = -(x[c][q] - centre[q]);
        r[3 * c + q] = x[c][p] - centre[p];
      }
    }
    for (double value : r) length2 += value * value;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) a[i][j] += stiffness * r[i] * r[j] / length2;
  }
  SolveDense<n>(a, force, w);
}

/// Offsets of a form whose points are corners. Stresses of the corners alone would not be in balance where they have a
/// gradient: what their forces lack to those of full integration is taken up elastically.
template <class Form, class Law>
void StartCorners(const Tables &tables, const ElementTable &t, const Material &m, int e, ElementHistories *h) {
  constexpr int corners = Form::kCorners, n = 3 * corners;
  double x[corners][3], u[corners][3] = {}, full[corners][3], have[corners][3], lacking[n];
  double of_full[HexFull::kPoints][6], stress[corners][6], more[corners][6];
  for (int a = 0; a < corners; ++a) std::copy_n(&tables.x[3 * static_cast<std::size_t>(t.Node(a, e))], 3, x[a]);
  const double *param = &tables.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
  for (int g = 0; g < HexFull::kPoints; ++g) {
    StressAt(m, PointHeight<HexFull>(x, g), of_full[g]);
    StressAt(m, x[Form::Corner(0, g >> 1, g & 1)][2], stress[g]);
  }
  HexFull::Forces(x, u, PointTable{of_full, nullptr}, full);
  Form::Forces(x, u, PointTable{stress, nullptr}, have);
  for (int i = 0; i < n; ++i) lacking[i] = full[i / 3][i % 3] - have[i / 3][i % 3];
  FreeDisplacements<Form>(x, param, lacking, &u[0][0]);
  Form::Forces(x, u, PointTable{nullptr, more}, have);
  for (int g = 0; g < corners; ++g) {
    double strain[6];
    StrainOfStress(param, stress[g], strain);
    for (int i = 0; i < 6; ++i)
      h->value[static_cast<std::size_t>(g * Law::kState + i) * t.n_pad + e] = -(strain[i] + more[g][i]);
  }
  h->state[e] |= kTouched;
}

template <class Form, class Law>
void StartElement(const Tables &tables, const ElementTable &t, const Material &m, int e, ElementHistories *h) {
  double x[Form::kCorners][3];
  for (int a = 0; a < Form::kCorners; ++a) std::copy_n(&tables.x[3 * static_cast<std::size_t>(t.Node(a, e))], 3, x[a]);
  const double *param = &tables.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
  for (int g = 0; g < Form::kPoints; ++g) {
    double stress[6], strain[6];
    StressAt(m, PointHeight<Form>(x, g), stress);
    StrainOfStress(param, stress, strain);  // the element has it without that strain
    for (int i = 0; i < 6; ++i) h->value[static_cast<std::size_t>(g * Law::kState + i) * t.n_pad + e] = -strain[i];
  }
  h->state[e] |= kTouched;
}

/// Force that the first side of a face puts on node j of the second one [N].
void FaceForce(const Mesh &mesh, const std::vector<Material> &materials, const Face &face, int j, double force[3]) {
  double x[4][3];
  const int size = FaceCorners(mesh, face, x);
  FacePoint points[4];
  const int n = FacePoints(size, x, points);
  std::fill_n(force, 3, 0.0);
  for (int g = 0; g < n; ++g) {
    double z = 0, first[6], second[6], traction[3];
    for (int i = 0; i < size; ++i) z += points[g].shape[i] * x[i][2];
    StressAt(materials[mesh.cell_region[face.cell[0]]], z, first);
    StressAt(materials[mesh.cell_region[face.cell[1]]], z, second);
    for (int i = 0; i < 6; ++i) first[i] = 0.5 * (first[i] + second[i]);
    Apply(first, points[g].area, traction);
    for (int k = 0; k < 3; ++k) force[k] -= points[g].shape[j] * traction[k];
  }
}

}  // namespace

void StartUnderStress(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials,
                      const Tables &tables, Histories *start) {
  start->elements = StartElements(tables);
  start->springs = StartSprings(tables);
  for (std::size_t g = 0; g < tables.elements.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
      using Form = decltype(form);
      using Law = decltype(law);
      for (int e = 0; e < t.n; ++e) {
        const Material &m = materials[t.region[e]];
        if constexpr (Form::kAtCorners && Law::kCarriesOffset) {
          if (m.stressed) StartCorners<Form, Law>(tables, t, m, e, &start->elements[g]);
        } else if constexpr (Law::kCarriesOffset) {
          if (m.stressed) StartElement<Form, Law>(tables, t, m, e, &start->elements[g]);
        }
      }
    });
  }
  for (std::size_t g = 0; g < tables.springs.size(); ++g) {
    const SpringTable &t = tables.springs[g];
    SpringHistory &h = start->springs[g];
    const std::vector<int> corner = SpringCorners(mesh, nodes, t);
    for (int i = 0; i < t.n; ++i) {
      double force[3], normal[3];
      FaceForce(mesh, materials, mesh.faces[t.face[i]], corner[i], force);
      for (int k = 0; k < 3; ++k) normal[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
      const double along = Dot(normal, force);
      JointLaws::Visit(t.law, [&](auto law) {
        using Law = decltype(law);
        if constexpr (Law::kCarriesOffset) {
          auto number = [&](int n) -> double & { return h.values[static_cast<std::size_t>(n) * t.n_pad + i]; };
          number(Law::kGap) = along / t.kn[i];
          for (int k = 0; k < 3; ++k) number(Law::kSlip + k) = (force[k] - along * normal[k]) / t.ks[i];
          h.state[i] |= kDamaged;
        }
      });
    }
  }
}

}  // namespace cdem
