// Tetrahedra of the form bbar: the averaged dilatation in bodies, against the whole stiffness matrix and known fields.
#include "small_body.hpp"

namespace cdem {
namespace {

/// A jittered box of tetrahedra with averaged dilatation.
void MakeTets(Body *body, const std::string &cells, double poisson) {
  body->Make("-mesh box -mesh_box_shape tet -mesh_box_jitter 0.2 -mesh_box_cells " + cells + " -mesh_box_size " +
             cells);
  body->materials = {MakeMaterial(1e10, poisson, 2500), MakeMaterial(3e9, poisson, 2500)};
  for (Material &m : body->materials) m.element = "bbar";
  body->mesh.regions = {"one", "two"};
}

TEST(TetBbar, StiffnessIsSymmetricAndItsEnergyIsTheWork) {
  Body body;
  MakeTets(&body, "2,2,2", 0.45);
  for (PetscInt c = 0; c < body.mesh.n_cells; ++c) body.mesh.cell_region[c] = body.CentreX(c) > 1;
  body.Build();
  ASSERT_EQ(body.tables.layers, 2);
  const std::vector<double> k = DenseStiffness(body.tables);
  const std::size_t n = body.tables.x.size();
  double most = 0, work = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) most = std::max(most, std::fabs(k[n * i + j] - k[n * j + i]));
  EXPECT_LE(most, 1e-14 * Largest(k));
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
  std::vector<double> u(n);
  for (double &value : u) value = entry(random);
  ElementResults results;
  const std::vector<double> f = InternalForces(body.tables, u, &results);
  for (std::size_t i = 0; i < n; ++i) work += 0.5 * u[i] * f[i];
  EXPECT_GT(work, 0);
  EXPECT_NEAR(results.energy, work, 1e-12 * work);
}

TEST(TetBbar, BodyHasSixZeroModes) {
  Body body;
  MakeTets(&body, "2,1,1", 0.3);
  body.Build();
  const std::size_t n = body.tables.x.size();
  // K + s 1 loses its Cholesky factor as soon as s makes the number of negative pivots change: count them
  const auto below = [&](double shift) {
    std::vector<double> a = DenseStiffness(body.tables);
    int negative = 0;
    for (std::size_t i = 0; i < n; ++i) a[n * i + i] -= shift;
    for (std::size_t p = 0; p < n; ++p) {  // L D L^T: as many negative pivots as eigenvalues below the shift
      negative += a[n * p + p] < 0;
      for (std::size_t i = p + 1; i < n; ++i)
        for (std::size_t j = p + 1; j < n; ++j) a[n * i + j] -= a[n * i + p] * a[n * p + j] / a[n * p + p];
    }
    return negative;
  };
  const double size = Largest(DenseStiffness(body.tables));
  EXPECT_EQ(below(-1e-10 * size), 0);
  EXPECT_EQ(below(1e-10 * size), 6);
  EXPECT_EQ(below(1e-3 * size), 6);
}

// Two materials in series under one stress: the dilatation jumps between them, and is not smeared.
TEST(TetBbar, DoesNotAverageAcrossMaterials) {
  Body body;
  body.Make("-mesh box -mesh_box_shape tet -mesh_box_cells 4,3,3 -mesh_box_size 4,3,3");
  body.materials = {MakeMaterial(1e10, 0.25, 2500), MakeMaterial(2e9, 0.4, 2500)};
  for (Material &m : body.materials) m.element = "bbar";
  body.mesh.regions = {"one", "two"};
  for (PetscInt c = 0; c < body.mesh.n_cells; ++c) body.mesh.cell_region[c] = body.CentreX(c) > 2;
  body.Build();
  double strain[2];
  for (int m = 0; m < 2; ++m) strain[m] = 1e6 / (body.materials[m].lambda() + 2 * body.materials[m].mu());
  std::vector<double> u(body.tables.x.size(), 0.0);
  for (std::size_t i = 0; i < u.size(); i += 3) {
    const double x = body.tables.x[i];
    u[i] = x < 2 ? strain[0] * x : 2 * strain[0] + (x - 2) * strain[1];
  }
  std::vector<double> stress(6 * static_cast<std::size_t>(body.mesh.n_cells));
  ElementResults results;
  results.stress = stress.data();
  const std::vector<double> f = InternalForces(body.tables, u, &results);
  for (std::size_t c = 0; c < stress.size(); c += 6) EXPECT_NEAR(stress[c + kXX], 1e6, 1e-12 * 1e6);
  for (std::size_t i = 0; i < u.size(); i += 3) {
    const double x = body.tables.x[i];
    if (x > 0 && x < 4) {
      EXPECT_NEAR(f[i], 0, 1e-12 * 1e6) << x;
    }
  }
}

}  // namespace
}  // namespace cdem
