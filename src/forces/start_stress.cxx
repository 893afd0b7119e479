#include "forces/references.hpp"

#include "mesh/geometry.hpp"
#include "physics/elements.hpp"

#include <algorithm>

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
      if constexpr (decltype(law)::kCarriesOffset)
        for (int e = 0; e < t.n; ++e)
          if (materials[t.region[e]].stressed)
            StartElement<decltype(form), decltype(law)>(tables, t, materials[t.region[e]], e, &start->elements[g]);
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
