// Patch tests: linear displacement fields on distorted elements, alone and with springs that carry the uniform stress.
#include "small_body.hpp"

#include <numeric>

namespace cdem {
namespace {

constexpr double kBar = 1e-12;
const std::string kBox = "-mesh box -mesh_box_cells 4,4,3 -mesh_box_size 4,4,3 ";
const char *const kShapeNames[] = {"hex", "tet", "wedge"};

/// The stress of every element is that given, up to kBar of its largest component.
void ExpectStress(const std::vector<double> &stress, const double exact[6]) {
  const double size = Largest({exact, exact + 6});
  ASSERT_FALSE(stress.empty());
  double most = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) most = std::max(most, std::fabs(stress[i] - exact[i % 6]));
  EXPECT_LE(most, kBar * size);
}

/// Forces equal the loads at every node, up to kBar of the largest corner force.
void ExpectBalance(const std::vector<double> &f, const std::vector<double> &load, double corner_force) {
  ASSERT_GT(corner_force, 0);
  EXPECT_LE(RelativeDifference(f, load) * Largest(load) / corner_force, kBar);
}

class Patch : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::string options = GetParam();
    const std::size_t at = options.find("FILE/");
    if (at != std::string::npos) options.replace(at, 4, MeshFolder());
    scene_ = SetUpScene(kRock + (" -ts_max_steps 1 -device cpu " + options), PETSC_COMM_SELF);
    ASSERT_NE(scene_, nullptr);
  }
  const Tables &tables() const { return scene_->tables(); }
  std::unique_ptr<Simulation> scene_;
};

class AnyPatch : public Patch {};  // split too: springs do not carry a field without jumps

TEST_P(Patch, LinearFieldIsExact) {
  const Gradient g = Gradient::Random(1e-3, 17);
  const std::vector<double> u = LinearField(tables(), g);
  std::vector<double> stress(6 * static_cast<std::size_t>(scene_->mesh().n_cells));
  ElementResults results;
  results.stress = stress.data();
  double exact[6], volume = 0;
  g.Stress(scene_->materials()[0], exact);
  const std::vector<double> observed = InternalForces(tables(), u, &results);
  std::vector<double> plain(u.size(), 0.0);
  std::vector<ElementHistories> elements = StartElements(tables());
  HostElements(tables(), u.data(), nullptr, 0, 0, elements, plain.data());

  const double corner_force = LargestCornerForce(tables(), u);
  const std::vector<char> inner = InnerNodes(scene_->mesh(), scene_->nodes());
  double most = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    if (inner[i / 3]) most = std::max({most, std::fabs(observed[i]), std::fabs(plain[i])});
  EXPECT_GT(std::accumulate(inner.begin(), inner.end(), 0), 0) << "no inner node";
  EXPECT_LE(most, kBar * corner_force);
  std::printf("    inner nodes: %.1e of the largest corner force\n", most / corner_force);
  ExpectBalance(observed, BoundaryLoads(scene_->mesh(), scene_->nodes(), exact), corner_force);
  ExpectStress(stress, exact);
  for (std::size_t r = 0; r < scene_->mesh().regions.size(); ++r) volume += Volume(scene_->mesh(), static_cast<int>(r));
  const double energy = volume * g.Energy(exact);
  EXPECT_NEAR(results.energy, energy, kBar * energy);
}

TEST_P(AnyPatch, RigidMotionIsForceFree) {
  std::vector<double> u(tables().x.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = i % 3 + 0.1;
  EXPECT_EQ(Largest(InternalForces(tables(), u)), 0) << "translation";
  Gradient turn, shear;
  const double w[3] = {1e-3, -2e-3, 1.5e-3};
  turn.g[2][1] = w[0], turn.g[0][2] = w[1], turn.g[1][0] = w[2];
  shear = turn;
  turn.g[1][2] = -w[0], turn.g[2][0] = -w[1], turn.g[0][1] = -w[2];
  EXPECT_LE(Largest(InternalForces(tables(), LinearField(tables(), turn))),
            kBar * LargestCornerForce(tables(), LinearField(tables(), shear)));
}

TEST_P(AnyPatch, ForcesAndMomentsOfAnyFieldCancel) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
  std::vector<double> u(tables().x.size());
  for (double &value : u) value = entry(random);
  const std::vector<double> f = InternalForces(tables(), u);
  double force[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, arm = 0, size = 0;
  for (std::size_t i = 0; i < f.size(); i += 3) {
    double m[3];
    Cross(&tables().x[i], &f[i], m);
    for (int k = 0; k < 3; ++k) {
      force[k] += f[i + k], moment[k] += m[k], size += std::fabs(f[i + k]);
      arm = std::max(arm, std::fabs(tables().x[i + k]));
    }
  }
  for (int k = 0; k < 3; ++k) EXPECT_LE(std::fabs(force[k]), kBar * size);
  for (int k = 0; k < 3; ++k) EXPECT_LE(std::fabs(moment[k]), kBar * size * arm);
}

const std::string kJitter = kBox + "-mesh_box_jitter 0.2 ";
const std::string kSprings = "-block_law spring -block_tension 1e30 -block_cohesion 1e30 -block_friction 0 ";
const auto kJoined = testing::Values(kJitter, kJitter + "-mesh_box_shape tet", kJitter + "-mesh_box_shape wedge",
                                     "-mesh FILE/mixed_41a.msh", "-mesh FILE/mixed_22b.msh -dm_refine 1");
const auto kForms = testing::Values(kJitter + "-block_element bbar", kJitter + "-block_element onepoint",
                                    kJitter + "-block_element bbar -mesh_box_shape wedge",
                                    kJitter + "-block_element bbar -mesh_box_shape tet",
                                    std::string("-mesh FILE/mixed_41a.msh -block_element bbar"));
const auto kSpringBoxes = testing::Values(kJitter + kSprings + "-block_poisson 0", kJitter + kSprings,
                                          kJitter + kSprings + "-block_poisson 0.45");
INSTANTIATE_TEST_SUITE_P(Joined, Patch, kJoined);
const std::string kStrong = " -block_cohesion 1e9 -block_friction 30 -block_tension 1e8 -block_law ";
INSTANTIATE_TEST_SUITE_P(Laws, Patch,
                         testing::Values(kBox + "-mesh_box_jitter 0.2" + kStrong + "drucker_prager",
                                         kBox + "-mesh_box_jitter 0.2" + kStrong + "mohr_coulomb",
                                         kBox + "-mesh_box_jitter 0.2" + kStrong + "breakage",
                                         "-mesh FILE/mixed_41a.msh" + kStrong + "drucker_prager",
                                         "-mesh FILE/mixed_41a.msh" + kStrong + "mohr_coulomb",
                                         "-mesh FILE/mixed_41a.msh" + kStrong + "breakage"));
INSTANTIATE_TEST_SUITE_P(Joined, AnyPatch, kJoined);
INSTANTIATE_TEST_SUITE_P(Forms, Patch, kForms);
INSTANTIATE_TEST_SUITE_P(Forms, AnyPatch, kForms);
INSTANTIATE_TEST_SUITE_P(DiscreteSprings, Patch, kSpringBoxes);
INSTANTIATE_TEST_SUITE_P(DiscreteSprings, AnyPatch, kSpringBoxes);
INSTANTIATE_TEST_SUITE_P(Jointed, AnyPatch,
                         testing::Values(kJitter + "-interfaces j -interface_j_on all",
                                         "-mesh FILE/mixed_41a.msh -interfaces fault -interface_fault_law brittle "
                                         "-interface_tension 1e9 -interface_cohesion 1e9 -interface_friction 30"));

/// A body that a plane halves: a box whose vertices move at random (within the plane, and within the sides), or the mixed
/// mesh and its fault; then turned and sheared. second: per cell.
void MakeHalved(const std::string &shape, Body *body, std::vector<char> *second) {
  const bool mixed = shape == "mixed";
  const double plane = mixed ? 1 : 2, side[3] = {4, 3, 3};
  body->Make(mixed ? "-mesh " + MeshFolder() + "/mixed_41b.msh -dm_refine 1"
                   : "-mesh box -mesh_box_cells 4,3,3 -mesh_box_size 4,3,3 -mesh_box_shape " + shape);
  body->materials.resize(body->mesh.regions.size(), body->materials[0]);
  for (PetscInt c = 0; c < body->mesh.n_cells; ++c) second->push_back(body->CentreX(c) > plane);
  body->Split([&](PetscInt c0, PetscInt c1) { return (*second)[c0] != (*second)[c1]; });
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  body->Move([&](double x[3]) {
    double y[3];
    for (int k = 0; k < 3; ++k) {
      const double by = shift(random);
      const bool stays = mixed || x[k] == 0 || x[k] == side[k] || (k == 0 && x[k] == plane);
      y[k] = x[k] + (stays ? 0 : by);
    }
    x[0] = 0.9 * y[0] - 0.3 * y[1] + 0.2 * y[2];
    x[1] = 0.3 * y[0] + 0.8 * y[1] - 0.1 * y[2];
    x[2] = -0.2 * y[0] + 0.3 * y[1] + 1.1 * y[2];
  });
}

/// d = u_b - u_a [m] of springs that carry sigma across n, from a to b, of k_n, k_s [Pa/m].
void Jump(const double stress[6], const double n[3], double kn, double ks, double d[3]) {
  double t[3];
  Apply(stress, n, t);
  const double along = Dot(n, t);
  for (int k = 0; k < 3; ++k) d[k] = along * n[k] / kn + (t[k] - along * n[k]) / ks;
}

/// [in] g: of both halves; the second one is moved by what the springs need. All nodes must be in balance.
void ExpectPlaneCarries(const std::string &shape, const Joint &joint, const Gradient &g) {
  Body body;
  std::vector<char> second;
  MakeHalved(shape, &body, &second);
  body.joints = {joint};
  body.Build();
  ASSERT_EQ(body.tables.springs.size(), 1u);
  const SpringTable &springs = body.tables.springs[0];
  ASSERT_EQ(body.nodes.n_blocks, 2);
  double n[3], d[3], exact[6];
  const double sign = second[body.mesh.faces[springs.face[0]].cell[0]] ? -1 : 1;
  for (int k = 0; k < 3; ++k) n[k] = sign * springs.normal[static_cast<std::size_t>(k) * springs.n_pad];
  g.Stress(body.materials[0], exact);
  Jump(exact, n, joint.kn, joint.ks, d);
  std::vector<double> u = LinearField(body.tables, g);
  std::vector<char> moved(body.nodes.n_local, 0);
  for (PetscInt c = 0; c < body.mesh.n_cells; ++c)
    for (int a = 0; second[c] && a < Info(body.mesh.cell_shape[c]).corners; ++a) moved[body.nodes.Corners(c)[a]] = 1;
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += moved[i / 3] ? d[i % 3] : 0;
  std::vector<double> stress(6 * static_cast<std::size_t>(body.mesh.n_cells)), f(u.size(), 0.0);
  ElementResults results;
  results.stress = stress.data();
  const std::vector<double> load = BoundaryLoads(body.mesh, body.nodes, exact);
  const double corner_force = LargestCornerForce(body.tables, u);
  ExpectBalance(InternalForces(body.tables, u, &results), load, corner_force);
  ExpectStress(stress, exact);
  // the committing passes too, and nothing breaks
  std::vector<SpringHistory> history = StartSprings(body.tables), start = history;
  std::vector<ElementHistories> elements = StartElements(body.tables);
  HostElements(body.tables, u.data(), nullptr, 0, 0, elements, f.data());
  HostSprings(body.tables, u.data(), nullptr, 0, history, f.data());
  ExpectBalance(f, load, corner_force);
  std::printf("    %-5s with springs on a plane: %.1e of the largest corner force\n", shape.c_str(),
              RelativeDifference(f, load) * Largest(load) / corner_force);
  EXPECT_EQ(history[0].state, start[0].state);
}

TEST(PatchWithSprings, OnOnePlane) {
  Joint elastic, brittle, crack;
  elastic.kn = brittle.kn = crack.kn = 2e11;
  elastic.ks = brittle.ks = crack.ks = 0.7e11;
  brittle.law = crack.law = JointLaws::Find("brittle");
  const double strong[] = {1e9, 1e9, 30}, none[] = {0, 0, 40};
  JointBrittle::Derive(strong, brittle.param);
  JointBrittle::Derive(none, crack.param);
  crack.broken = true;
  Gradient pressed = Gradient::Random(1e-4, 8);
  for (int k = 0; k < 3; ++k) pressed.g[k][k] -= 1e-3;
  for (const char *shape : {"hex", "tet", "wedge", "mixed"}) {
    SCOPED_TRACE(shape);
    ExpectPlaneCarries(shape, elastic, Gradient::Random(1e-3, 2));
    ExpectPlaneCarries(shape, brittle, Gradient::Random(1e-3, 3));
    ExpectPlaneCarries(shape, crack, pressed);  // closed and rubbing, but it sticks
  }
}

TEST(PatchWithSprings, OnAllFacesOfRegularBoxes) {
  for (double b : {1.0, 20.0}) {
    Body body;
    body.Make("-mesh box -mesh_box_cells 4,3,3 -mesh_box_size 4,3,3");
    const double edge[3][3] = {{0.9, 0.3, -0.2}, {-0.3, 0.8, 0.3}, {0.2, -0.1, 1.1}};
    body.Move([&](double x[3]) {
      const double y[3] = {x[0], x[1], x[2]};
      for (int k = 0; k < 3; ++k) x[k] = edge[0][k] * y[0] + edge[1][k] * y[1] + edge[2][k] * y[2];
    });
    body.SplitAll();
    body.joints[0].stiffness_factor = b;
    body.Build();
    EXPECT_EQ(body.nodes.n_local, 8 * 36);
    const Gradient g = Gradient::Random(1e-3, 4);
    double exact[6], d[3][3];
    g.Stress(body.materials[0], exact);
    for (int i = 0; i < 3; ++i) {
      double n[3];
      Cross(edge[(i + 1) % 3], edge[(i + 2) % 3], n);
      const double size = std::sqrt(Dot(n, n)), h = std::sqrt(Dot(edge[i], edge[i]));
      for (double &component : n) component /= size;
      const Material &m = body.materials[0];
      Jump(exact, n, b * (m.lambda() + 2 * m.mu()) / h, b * m.mu() / h, d[i]);
    }
    std::vector<double> u = LinearField(body.tables, g);
    for (PetscInt c = 0; c < 36; ++c)
      for (int a = 0; a < 8; ++a)
        for (int k = 0; k < 3; ++k)
          u[3 * body.nodes.Corners(c)[a] + k] += static_cast<double>(c % 4) * d[0][k] +
                                                 static_cast<double>(c / 4 % 3) * d[1][k] +
                                                 static_cast<double>(c / 12) * d[2][k];
    ExpectBalance(InternalForces(body.tables, u), BoundaryLoads(body.mesh, body.nodes, exact),
                  LargestCornerForce(body.tables, u));
  }
}

/// Largest deviation from a uniform stress, over its largest component, of a body with springs of factor b on all
/// faces that its boundary loads with that stress.
double Deviation(const std::string &shape, double b) {
  Body body;
  body.Make("-mesh box -mesh_box_cells 3,2,2 -mesh_box_size 3,2,2 -mesh_box_jitter 0.2 -mesh_box_shape " + shape);
  body.SplitAll();
  body.joints[0].stiffness_factor = b;
  body.Build();
  double exact[6];
  Gradient::Random(1e-3, 6).Stress(body.materials[0], exact);
  std::vector<double> u = BoundaryLoads(body.mesh, body.nodes, exact), k = DenseStiffness(body.tables);
  HoldRigidMotions(body.tables, k);  // the loads do not work on them
  EXPECT_TRUE(Factor(k, u.size()));
  SolveFactored(k, u);
  std::vector<double> stress(6 * static_cast<std::size_t>(body.mesh.n_cells));
  ElementResults results;
  results.stress = stress.data();
  InternalForces(body.tables, u, &results);
  double most = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) most = std::max(most, std::fabs(stress[i] - exact[i % 6]));
  return most / Largest({exact, exact + 6});
}

TEST(PatchWithSprings, OnAllFacesOfADistortedBodyTheDeviationFallsLikeOneOverB) {
  for (const char *shape : kShapeNames) {
    const double at20 = Deviation(shape, 20), at200 = Deviation(shape, 200), at2000 = Deviation(shape, 2000);
    std::printf("    %-5s deviation at b = 20, 200, 2000: %.2e %.2e %.2e\n", shape, at20, at200, at2000);
    EXPECT_LT(at20, 0.1);
    EXPECT_NEAR(at20 / at200, 10, 2.5);
    EXPECT_NEAR(at200 / at2000, 10, 0.5);
  }
}

}  // namespace
}  // namespace cdem
