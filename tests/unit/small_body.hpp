// A small body put together by hand inside a test (mesh, interfaces, materials, joints, tables), and what tests ask of
// it: forces of a displacement field, loads of a uniform stress, the dense stiffness matrix.
#pragma once
#include "../support/run_scene.hpp"
#include "mesh_make.hpp"

#include <functional>
#include <numeric>
#include <random>

namespace cdem {

inline Material MakeMaterial(double young, double poisson, double density) {
  Material m;
  const double property[] = {young, poisson};
  Elastic::Derive(property, 1, m.param);
  m.density = density;
  return m;
}

struct Body {
  Mesh mesh;
  std::vector<int> face_interface;
  Nodes nodes;
  std::vector<Material> materials{MakeMaterial(1e10, 0.25, 2500)};
  std::vector<Joint> joints{Joint()};
  Tables tables;

  /// [in] options: of the mesh, as on a command line.
  void Make(const std::string &options) {
    ASSERT_PETSC(RegisterOnce());
    ASSERT_PETSC(cdem::Make(PETSC_COMM_SELF, options, &mesh));
    face_interface.assign(mesh.faces.size(), -1);
  }
  /// Moves every vertex.
  void Move(const std::function<void(double x[3])> &place) {
    for (std::size_t v = 0; v < mesh.vertex_x.size() / 3; ++v) place(&mesh.vertex_x[3 * v]);
  }
  /// Makes inner faces interfaces of joint 0 where wanted(cell 0, cell 1) says so.
  void Split(const std::function<bool(PetscInt, PetscInt)> &wanted) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      if (mesh.faces[f].cell[1] >= 0 && wanted(mesh.faces[f].cell[0], mesh.faces[f].cell[1])) face_interface[f] = 0;
  }
  void SplitAll() {
    Split([](PetscInt, PetscInt) { return true; });
  }
  void Build() {
    ASSERT_PETSC(CreateNodes(mesh, face_interface, &nodes));
    ASSERT_PETSC(BuildTables(mesh, nodes, face_interface, materials, joints, {}, &tables));
  }
  void Centre(PetscInt cell, double centre[3]) const {
    const int corners = Info(mesh.cell_shape[cell]).corners;
    std::fill_n(centre, 3, 0.0);
    for (int a = 0; a < corners; ++a)
      for (int k = 0; k < 3; ++k) centre[k] += mesh.X(mesh.Corners(cell)[a])[k] / corners;
  }
  double CentreX(PetscInt cell) const {
    double centre[3];
    Centre(cell, centre);
    return centre[0];
  }
};

inline double Largest(const std::vector<double> &values) {
  double most = 0;
  for (double value : values) most = std::max(most, std::fabs(value));
  return most;
}

/// A displacement gradient of random entries up to size.
struct Gradient {
  double g[3][3] = {};
  static Gradient Random(double size, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> entry(-size, size);
    Gradient r;
    for (auto &row : r.g)
      for (double &value : row) value = entry(random);
    return r;
  }
  void Apply(const double x[3], double u[3]) const {
    for (int k = 0; k < 3; ++k) u[k] = g[k][0] * x[0] + g[k][1] * x[1] + g[k][2] * x[2];
  }
  /// D : sym(G), by the formula and not by the law.
  void Stress(const Material &m, double s[6]) const {
    const double pressure = m.lambda() * (g[0][0] + g[1][1] + g[2][2]);
    for (int k = 0; k < 3; ++k) s[k] = 2 * m.mu() * g[k][k] + pressure;
    s[kXY] = m.mu() * (g[0][1] + g[1][0]);
    s[kYZ] = m.mu() * (g[1][2] + g[2][1]);
    s[kXZ] = m.mu() * (g[0][2] + g[2][0]);
  }
  /// G : sigma / 2 [J/m^3].
  double Energy(const double s[6]) const {
    return 0.5 * (s[kXX] * g[0][0] + s[kYY] * g[1][1] + s[kZZ] * g[2][2] + s[kXY] * (g[0][1] + g[1][0]) +
                  s[kYZ] * (g[1][2] + g[2][1]) + s[kXZ] * (g[0][2] + g[2][0]));
  }
};

/// u = G x at all nodes of these tables.
inline std::vector<double> LinearField(const Tables &tables, const Gradient &gradient) {
  std::vector<double> u(tables.x.size());
  for (std::size_t i = 0; i < u.size(); i += 3) gradient.Apply(&tables.x[i], &u[i]);
  return u;
}

/// Internal forces of elements and springs, from rest; elements may be NULL.
inline std::vector<double> InternalForces(const Tables &tables, const std::vector<double> &u,
                                          ElementResults *elements = nullptr, SpringResults *springs = nullptr) {
  std::vector<double> f(u.size(), 0.0);
  ElementResults unused;
  SpringResults unused_too;
  HostElementsObserve(tables, 1 << 30, u.data(), nullptr, 0, StartElements(tables), f.data(),
                      elements ? elements : &unused);
  HostSpringsObserve(tables, u.data(), nullptr, 0, StartSprings(tables), f.data(), springs ? springs : &unused_too);
  return f;
}

/// The largest component of a corner force [N] before corners are summed.
inline double LargestCornerForce(const Tables &tables, const std::vector<double> &u) {
  double most = 0;
  for (const ElementTable &t : tables.elements)
    for (int e = 0; e < t.n; ++e)
      VisitElement(t.shape, t.form, [&](auto form) {
        constexpr int corners = decltype(form)::kCorners;
        double x[corners][3], w[corners][3], f[corners][3];
        for (int a = 0; a < corners; ++a) {
          const std::size_t node = t.node[static_cast<std::size_t>(a) * t.n_pad + e];
          std::copy_n(&tables.x[3 * node], 3, x[a]);
          std::copy_n(&u[3 * node], 3, w[a]);
        }
        ElementForce<decltype(form), Elastic, false, double>(
            x, w, &tables.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]], f, nullptr);
        for (int a = 0; a < corners; ++a)
          for (int k = 0; k < 3; ++k) most = std::max(most, std::fabs(f[a][k]));
      });
  return most;
}

/// Nodes off the outer boundary.
inline std::vector<char> InnerNodes(const Mesh &mesh, const Nodes &nodes) {
  std::vector<char> inner(nodes.n_local, 1);
  for (const Face &face : mesh.faces)
    for (int j = 0; face.cell[1] < 0 && j < Info(mesh.cell_shape[face.cell[0]]).face_size[face.local[0]]; ++j)
      inner[FaceNode(mesh, nodes, face, j, 0)] = 0;
  return inner;
}

/// The nodal loads of a uniform stress: the integrals of N_j sigma n dA over the outer boundary.
inline std::vector<double> BoundaryLoads(const Mesh &mesh, const Nodes &nodes, const double stress[6]) {
  std::vector<double> load(3 * static_cast<std::size_t>(nodes.n_local), 0.0);
  for (const Face &face : mesh.faces) {
    if (face.cell[1] >= 0) continue;
    const ShapeInfo &info = Info(mesh.cell_shape[face.cell[0]]);
    const int size = info.face_size[face.local[0]];
    double x[4][3], area[4][3];
    for (int j = 0; j < size; ++j)
      std::copy_n(mesh.X(mesh.Corners(face.cell[0])[info.face[face.local[0]][j]]), 3, x[j]);
    FaceVectors(size, x, area);
    for (int j = 0; j < size; ++j)
      ApplyAdd(stress, area[j], &load[3 * static_cast<std::size_t>(FaceNode(mesh, nodes, face, j, 0))]);
  }
  return load;
}

/// The stiffness matrix of elements and springs, column by column [n][n].
inline std::vector<double> DenseStiffness(const Tables &tables) {
  const std::size_t n = tables.x.size();
  std::vector<double> k(n * n), u(n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    u[j] = 1;
    const std::vector<double> f = InternalForces(tables, u);
    u[j] = 0;
    std::copy(f.begin(), f.end(), k.begin() + static_cast<std::ptrdiff_t>(n * j));
  }
  return k;
}

/// Adds stiffness against the six rigid motions to a stiffness matrix, and nothing to any other motion.
inline void HoldRigidMotions(const Tables &tables, std::vector<double> &k) {
  const std::size_t n = tables.x.size();
  const double stiff = k[0];
  std::vector<std::vector<double>> rigid;
  for (int r = 0; r < 6; ++r) {
    std::vector<double> m(n, 0.0);
    for (std::size_t i = 0; i < n; i += 3) {
      if (r < 3) m[i + r] = 1;
      const double axis[3] = {r == 3 ? 1.0 : 0, r == 4 ? 1.0 : 0, r == 5 ? 1.0 : 0};
      if (r >= 3) Cross(axis, &tables.x[i], &m[i]);
    }
    for (const auto &other : rigid) {
      const double share = std::inner_product(m.begin(), m.end(), other.begin(), 0.0);
      for (std::size_t i = 0; i < n; ++i) m[i] -= share * other[i];
    }
    const double size = std::sqrt(std::inner_product(m.begin(), m.end(), m.begin(), 0.0));
    for (double &value : m) value /= size;
    rigid.push_back(m);
  }
  for (const auto &m : rigid)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) k[n * i + j] += stiff * m[i] * m[j];
}

/// Cholesky factor L of a symmetric matrix [n][n], in place below the diagonal; false when it is not positive definite.
inline bool Factor(std::vector<double> &a, std::size_t n) {
  std::vector<double> column(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (!(a[n * k + k] > 0)) return false;
    const double pivot = std::sqrt(a[n * k + k]);
    for (std::size_t i = k; i < n; ++i) column[i] = a[n * i + k] /= pivot;
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = k + 1; j <= i; ++j) a[n * i + j] -= column[i] * column[j];
  }
  return true;
}

/// x = A^-1 b, in place, from the factor.
inline void SolveFactored(const std::vector<double> &factor, std::vector<double> &b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; b[i] /= factor[n * i + i], ++i)
    for (std::size_t j = 0; j < i; ++j) b[i] -= factor[n * i + j] * b[j];
  for (std::size_t i = n; i-- > 0;) {
    b[i] /= factor[n * i + i];
    for (std::size_t j = 0; j < i; ++j) b[j] -= factor[n * i + j] * b[i];
  }
}

/// The largest eigenvalue w^2 [1/s^2] of M^-1/2 K M^-1/2 over the components that free_dof [n] names, to 1e-9 and from
/// above: w^2 1 - A has a Cholesky factor exactly when w^2 is larger.
inline double LargestW2(const Tables &tables, const std::vector<char> &free_dof) {
  const std::vector<double> k = DenseStiffness(tables);
  std::vector<std::size_t> dof;
  for (std::size_t i = 0; i < free_dof.size(); ++i)
    if (free_dof[i]) dof.push_back(i);
  const std::size_t n = dof.size(), stride = free_dof.size();
  std::vector<double> a(n * n), shifted;
  double low = 0, high = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < n; ++j) {
      a[n * i + j] = 0.5 * (k[dof[i] * stride + dof[j]] + k[dof[j] * stride + dof[i]]) *
                     std::sqrt(tables.inverse_mass[dof[i] / 3] * tables.inverse_mass[dof[j] / 3]);
      row += std::fabs(a[n * i + j]);
    }
    low = std::max(low, a[n * i + i]);
    high = std::max(high, row);
  }
  high *= 1 + 1e-12;
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    shifted.assign(a.begin(), a.end());
    for (double &entry : shifted) entry = -entry;
    for (std::size_t i = 0; i < n; ++i) shifted[n * i + i] += middle;
    (Factor(shifted, n) ? high : low) = middle;
  }
  return high;
}

}  // namespace cdem
