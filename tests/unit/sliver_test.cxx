// One flat element among 100,000: the sharp critical step must not miss it. Minutes of computing, so it is run by hand:
// cdem_unit --gtest_also_run_disabled_tests --gtest_filter=Sliver.*
#include "forces/elastic_operator.hpp"
#include "forces/sharp_step.hpp"
#include "small_body.hpp"

#include <petscksp.h>

namespace cdem {
namespace {

/// Numbers from -1 to 1 that belong to a place of the lattice: the same in the body and in a part cut out of it.
void Shake(const double x[3], unsigned seed, double shift[3]) {
  std::seed_seq places{static_cast<unsigned>(std::lround(x[0])), static_cast<unsigned>(std::lround(x[1])),
                       static_cast<unsigned>(std::lround(x[2])), seed};
  std::mt19937 random(places);
  for (int k = 0; k < 3; ++k) shift[k] = 2 * (random() / 4294967296.0) - 1;
}

/// A vertex of the lattice that is moved until the flattest cell there has that part of its volume.
struct Sliver {
  double at[3], to[3];
};

bool Same(const double *a, const double *b) {
  return std::fabs(a[0] - b[0]) + std::fabs(a[1] - b[1]) + std::fabs(a[2] - b[2]) < 0.1;
}

/// Cells round the vertex at a place, by corner volumes: the least determinant at the corners, over 1.
std::vector<PetscInt> Star(const Mesh &mesh, const double at[3]) {
  std::vector<PetscInt> cells;
  for (PetscInt c = 0; c < mesh.n_cells; ++c)
    for (int a = 0; a < Info(mesh.cell_shape[c]).corners; ++a)
      if (Same(mesh.X(mesh.Corners(c)[a]), at)) cells.push_back(c);
  return cells;
}

double CellVolume(const Mesh &mesh, PetscInt c) {
  double x[kMaxCorners][3], volume[kMaxCorners];
  CellCorners(mesh, c, x);
  return CornerVolumes(mesh.cell_shape[c], x, volume);
}

/// The lattice, shaken a little, with its slivers. [in] cells, origin: of the box; the lattice has
/// edges of 1 m.
void MakeLattice(const std::string &shape, const int cells[3], const int origin[3], unsigned seed,
                 const std::vector<Sliver> &slivers, Body *body) {
  char options[200];
  std::snprintf(
      options, sizeof options,
      "-mesh box -mesh_box_shape %s -mesh_box_cells %d,%d,%d -mesh_box_size %d,%d,%d -mesh_box_origin %d,%d,%d",
      shape.c_str(), cells[0], cells[1], cells[2], cells[0], cells[1], cells[2], origin[0], origin[1], origin[2]);
  body->Make(options);
  body->Move([&](double x[3]) {
    double shift[3];
    Shake(x, seed, shift);
    for (const Sliver &s : slivers)
      if (Same(x, s.at)) {
        std::copy_n(s.to, 3, x);
        return;
      }
    for (const Sliver &s : slivers)  // what is flat may not be turned inside out
      if (std::max({std::fabs(x[0] - s.at[0]), std::fabs(x[1] - s.at[1]), std::fabs(x[2] - s.at[2])}) < 1.5) return;
    for (int k = 0; k < 3; ++k) x[k] += 0.08 * shift[k];
  });
}

/// Where to move a vertex inside the body so that the flattest cell there keeps `part` of its volume, or of its edge.
Sliver MakeSliver(const std::string &shape, int n, double part, std::mt19937 &random) {
  Sliver s;
  for (double &x : s.at) x = 4 + static_cast<int>(random() % (n - 8));
  const int origin[3] = {static_cast<int>(s.at[0]) - 2, static_cast<int>(s.at[1]) - 2, static_cast<int>(s.at[2]) - 2},
            cells[3] = {4, 4, 4};
  double direction[3] = {0, 0, 0};
  if (shape == "hex") {
    direction[random() % 3] = random() % 2 ? 1 - part : part - 1;
  } else {
    for (double &d : direction) d = 2 * (random() / 4294967296.0) - 1;
    Body still, moved;  // the volume of a tetrahedron is linear in the movement
    MakeLattice(shape, cells, origin, 0, {{{s.at[0], s.at[1], s.at[2]}, {s.at[0], s.at[1], s.at[2]}}}, &still);
    Sliver full = s;
    for (int k = 0; k < 3; ++k) full.to[k] = s.at[k] + direction[k];
    const std::vector<PetscInt> star = Star(still.mesh, s.at);
    MakeLattice(shape, cells, origin, 0, {full}, &moved);
    double most = 0;
    for (PetscInt c : star) most = std::max(most, 1 - CellVolume(moved.mesh, c) / CellVolume(still.mesh, c));
    for (double &d : direction) d *= (1 - part) / most;
  }
  for (int k = 0; k < 3; ++k) s.to[k] = s.at[k] + direction[k];
  return s;
}

/// The largest Ritz value of 300 Lanczos steps from another random vector [1/s^2]: below the exact w^2, by next to nothing.
double ManySteps(const Tables &tables, double w2) {
  Mat matrix;
  Vec b, x;
  KSP ksp;
  PC pc;
  PetscRandom random;
  std::vector<double> values(300), imaginary(300);
  PetscInt found;
  auto all = [&] {
    PetscFunctionBeginUser;
    PetscCall(CreateElasticOperator(tables, &matrix));
    PetscCall(MatShift(matrix, 0.01 * w2));
    PetscCall(MatCreateVecs(matrix, &x, &b));
    PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &random));
    PetscCall(VecSetRandom(b, random));
    PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
    PetscCall(KSPSetOperators(ksp, matrix, matrix));
    PetscCall(KSPSetType(ksp, KSPCG));
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCSetType(pc, PCNONE));
    PetscCall(KSPSetComputeEigenvalues(ksp, PETSC_TRUE));
    PetscCall(KSPSetTolerances(ksp, 0, 0, 1e300, 300));
    PetscCall(KSPSolve(ksp, b, x));
    PetscCall(KSPComputeEigenvalues(ksp, 300, values.data(), imaginary.data(), &found));
    PetscCall(KSPDestroy(&ksp));
    PetscCall(VecDestroy(&x));
    PetscCall(VecDestroy(&b));
    PetscCall(PetscRandomDestroy(&random));
    PetscCall(MatDestroy(&matrix));
    PetscFunctionReturn(PETSC_SUCCESS);
  };
  EXPECT_EQ(all(), PETSC_SUCCESS);
  return *std::max_element(values.begin(), values.begin() + found) - 0.01 * w2;
}

/// w^2 of the 5 x 5 x 5 cells round a place, their rim held, from dense eigenvalues: rigorously below that of the body.
double PatchW2(const std::string &shape, unsigned seed, const std::vector<Sliver> &slivers, const double at[3],
               const std::function<void(Body *)> &paint) {
  Body body;
  const int cells[3] = {5, 5, 5},
            origin[3] = {static_cast<int>(at[0]) - 2, static_cast<int>(at[1]) - 2, static_cast<int>(at[2]) - 2};
  MakeLattice(shape, cells, origin, seed, slivers, &body);
  paint(&body);
  body.Build();
  const std::vector<char> inner = InnerNodes(body.mesh, body.nodes);
  std::vector<char> free_dof(body.tables.x.size());
  for (std::size_t i = 0; i < free_dof.size(); ++i) free_dof[i] = inner[i / 3];
  return LargestW2(body.tables, free_dof);
}

/// 20 seeds; with a decoy, a second, flatter cell between heavy ones gives the bound but not the highest frequency.
void ExpectNotMissed(const std::string &shape, int n, bool decoy) {
  std::printf("    %-4s %8s %12s %12s %8s %8s %8s %6s\n", "seed", "part", "many steps", "sharp, s", "ratio", "patch",
              "bound", "steps");
  double least = 1, most = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double part = std::exp(std::log(0.02) * (seed + 0.5) / 20);  // from 0.9 to 0.02
    std::vector<Sliver> slivers{MakeSliver(shape, n, part, random)};
    if (decoy) slivers.push_back(MakeSliver(shape, n, 0.3 * part, random));
    const auto paint = [&](Body *body) {
      if (!decoy) return;
      body->materials = {MakeMaterial(1e10, 0.25, 2500), MakeMaterial(1e10, 0.25, 2500 * 50)};
      const std::vector<PetscInt> star = Star(body->mesh, slivers[1].to);
      PetscInt flattest = -1;
      for (PetscInt c : star)
        if (flattest < 0 || CellVolume(body->mesh, c) < CellVolume(body->mesh, flattest)) flattest = c;
      for (int a = 0; flattest >= 0 && a < Info(body->mesh.cell_shape[flattest]).corners; ++a)
        for (PetscInt c : Star(body->mesh, body->mesh.X(body->mesh.Corners(flattest)[a])))
          if (c != flattest) body->mesh.cell_region[c] = 1;
    };
    Body body;
    const int cells[3] = {n, n, n}, origin[3] = {0, 0, 0};
    MakeLattice(shape, cells, origin, seed, slivers, &body);
    paint(&body);
    body.Build();
    StepBound bound;
    SharpStep sharp;
    ASSERT_PETSC(ComputeStepBound(body.tables, body.materials, &bound));
    ASSERT_PETSC(ComputeSharpStep(body.mesh, body.nodes, body.tables, body.materials, bound, &sharp));
    const double exact = CriticalStep(ManySteps(body.tables, sharp.w2), 0),
                 patch = CriticalStep(PatchW2(shape, seed, slivers, slivers[0].at, paint), 0);
    std::printf("    %-4u %8.4f %12.5e %12.5e %8.4f %8.4f %8.4f %6d\n", seed, part, exact, sharp.dt, sharp.dt / exact,
                patch / exact, bound.dt / exact, sharp.iterations);
    std::fflush(stdout);
    EXPECT_TRUE(sharp.converged);
    EXPECT_LE(sharp.dt, exact);
    EXPECT_LE(sharp.dt, patch);
    EXPECT_GE(sharp.dt, 0.99 * exact);
    least = std::min(least, sharp.dt / exact);
    most = std::max(most, sharp.dt / exact);
  }
  std::printf("    %s: sharp over exact step from %.4f to %.4f\n", shape.c_str(), least, most);
}

TEST(Sliver, DISABLED_IsNotMissedAmong97336Hexahedra) { ExpectNotMissed("hex", 46, false); }
TEST(Sliver, DISABLED_IsNotMissedAmong105456Tetrahedra) { ExpectNotMissed("tet", 26, false); }
TEST(Sliver, DISABLED_IsNotMissedBesideADecoyInHexahedra) { ExpectNotMissed("hex", 46, true); }
TEST(Sliver, DISABLED_IsNotMissedBesideADecoyInTetrahedra) { ExpectNotMissed("tet", 26, true); }

}  // namespace
}  // namespace cdem
