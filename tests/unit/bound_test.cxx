// The cheap bound of the critical step against the exact one, from the dense stiffness matrix of small scenes.
#include "small_body.hpp"

namespace cdem {
namespace {

struct Scene {
  const char *name, *mesh;
  double b;            ///< stiffness factor of springs on all faces; 0: joined
  double poisson;      ///< of the blocks
  double least;        ///< bound over exact step, at least
  double beta = 0;     ///< s
  double soft = 1;     ///< Young's modulus of every second cell over that of the first
  bool fixed = false;  ///< all nodes at z = 0
  const char *element = "full";
};

const char *const kCubes = "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3";
const char *const kJitter = "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3 -mesh_box_jitter 0.3";
const char *const kPair = "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2";

const Scene kScenes[] = {
    {"two cubes, split, b = 1", "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1", 1, 0.25, 0.8},
    {"two cubes, split, b = 20", "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1", 20, 0.25, 0.8},
    {"8 cubes, split, b = 1", kPair, 1, 0.25, 0.8},
    {"8 cubes, split, b = 20", kPair, 20, 0.25, 0.8},
    {"18 cubes, split, b = 20", "-mesh box -mesh_box_cells 3,3,2 -mesh_box_size 3,3,2", 20, 0.25, 0.8},
    {"8 cubes, split, b = 20, nu = 0", kPair, 20, 0, 0.8},
    {"8 cubes, split, b = 20, nu = .45", kPair, 20, 0.45, 0.8},
    {"8 bricks, split, b = 20", "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,1,0.5", 20, 0.25, 0.8},
    {"8 cubes, split, b = 20, beta = 1e-5", kPair, 20, 0.25, 0.8, 1e-5},
    {"8 cubes, split, contrast 100", kPair, 20, 0.25, 0.5, 0, 0.01},
    {"one cube", "-mesh box -mesh_box_cells 1,1,1 -mesh_box_size 1,1,1", 0, 0.25, 0.98},
    {"27 cubes, joined, nu = 0", kCubes, 0, 0, 0.95},
    {"27 cubes, joined", kCubes, 0, 0.25, 0.75},
    {"27 cubes, joined, nu = .45", kCubes, 0, 0.45, 0.6},
    {"27 cubes, joined, fixed", kCubes, 0, 0.25, 0.75, 0, 1, true},
    {"27 cubes, joined, beta = 1e-4", kCubes, 0, 0.25, 0.75, 1e-4},
    {"27 hexahedra, joined, jitter", kJitter, 0, 0.25, 0.7},
    {"27 cubes, joined, contrast 100", kCubes, 0, 0.25, 0.6, 0, 0.01},
    {"48 tetrahedra, joined, jitter",
     "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_shape tet -mesh_box_jitter 0.2", 0, 0.25, 0.5},
    {"162 flat tetrahedra, joined",
     "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3 -mesh_box_shape tet -mesh_box_jitter 0.3", 0, 0.25, 0.3},
    {"12 tetrahedra, split, b = 20", "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1 -mesh_box_shape tet", 20,
     0.25, 0.6},
    {"36 wedges, joined, jitter",
     "-mesh box -mesh_box_cells 3,3,2 -mesh_box_size 3,3,2 -mesh_box_shape wedge -mesh_box_jitter 0.2", 0, 0.25, 0.6},
    {"16 wedges, split, b = 20", "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_shape wedge", 20, 0.25,
     0.6},
    {"27 cubes, joined, bbar", kCubes, 0, 0.25, 0.75, 0, 1, false, "bbar"},
    {"27 hexahedra, jitter, bbar, nu = .45", kJitter, 0, 0.45, 0.6, 0, 1, false, "bbar"},
    {"27 cubes, joined, onepoint", kCubes, 0, 0.25, 0.75, 0, 1, false, "onepoint"},
    {"27 hexahedra, jitter, onepoint", kJitter, 0, 0.25, 0.6, 0, 1, false, "onepoint"},
    {"8 cubes, split, b = 20, onepoint", kPair, 20, 0.25, 0.8, 0, 1, false, "onepoint"},
    {"27 cubes, joined, spring", kCubes, 0, 0.25, 0.75, 0, 1, false, "spring"},
    {"27 hexahedra, jitter, spring", kJitter, 0, 0.25, 0.5, 0, 1, false, "spring"},
    {"36 wedges, jitter, bbar",
     "-mesh box -mesh_box_cells 3,3,2 -mesh_box_size 3,3,2 -mesh_box_shape wedge -mesh_box_jitter 0.2", 0, 0.25, 0.6, 0,
     1, false, "bbar"},
    {"48 tetrahedra, jitter, bbar",
     "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_shape tet -mesh_box_jitter 0.2", 0, 0.25, 0.4, 0,
     1, false, "bbar"},
    {"48 tetrahedra, jitter, bbar, nu = .45, contrast 100",
     "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_shape tet -mesh_box_jitter 0.2", 0, 0.45, 0.2, 0,
     0.01, false, "bbar"},
};

TEST(StepBound, IsBelowTheExactStepAndNotFarBelow) {
  std::printf("    %-34s %12s %12s %8s\n", "scene", "exact dt, s", "bound, s", "ratio");
  for (const Scene &scene : kScenes) {
    SCOPED_TRACE(scene.name);
    Body body;
    body.Make(scene.mesh);
    body.materials = {MakeMaterial(1e10, scene.poisson, 2500), MakeMaterial(scene.soft * 1e10, scene.poisson, 2500)};
    for (PetscInt c = 0; c < body.mesh.n_cells; ++c) body.mesh.cell_region[c] = static_cast<int>(c % 2);
    for (Material &m : body.materials) {
      m.element = scene.element;
      if (m.element == "spring")
        m.law = BlockLaws::Find("spring"), m.param[SpringBlock::kTension] = 1e30,
        m.param[SpringBlock::kCohesion] = 1e30;
    }
    if (scene.b > 0) body.SplitAll();
    body.joints[0].stiffness_factor = scene.b;
    body.Build();
    ASSERT_LT(body.nodes.n_local, 150);
    body.tables.beta = scene.beta;
    std::vector<char> free_dof(body.tables.x.size(), 1);
    for (std::size_t i = 0; scene.fixed && i < free_dof.size(); ++i) free_dof[i] = body.tables.x[i / 3 * 3 + 2] > 0;
    StepBound bound;
    ASSERT_PETSC(ComputeStepBound(body.tables, body.materials, &bound));
    const double exact = CriticalStep(LargestW2(body.tables, free_dof), scene.beta);
    std::printf("    %-34s %12.5e %12.5e %8.4f\n", scene.name, exact, bound.dt, bound.dt / exact);
    EXPECT_LE(bound.dt, exact);
    EXPECT_GE(bound.dt, scene.least * exact);
    if (scene.b == 0) {
      EXPECT_EQ(bound.spring_w2, 0);
    }
  }
}

// Of an oscillator with damping 2 xi w = beta w^2: x(n+1) - x(n) = x(n) - x(n-1) - dt^2 w^2 x(n) - dt beta w^2 (x(n) - x(n-1))
// leaves the unit circle through -1 at dt^2 w^2 + 2 dt beta w^2 = 4.
TEST(StepBound, BetaLowersTheStep) {
  const double w2 = 3e6;
  EXPECT_DOUBLE_EQ(CriticalStep(w2, 0), 2 / std::sqrt(w2));
  for (double beta : {1e-6, 1e-4, 1e-2}) {
    const double dt = CriticalStep(w2, beta);
    EXPECT_NEAR(dt * dt * w2 + 2 * dt * beta * w2, 4, 1e-10);
  }
  EXPECT_TRUE(std::isinf(CriticalStep(0, 0)));
}

/// Largest |v| after some steps of the program's own run at this step.
double SpeedAfter(const std::string &scene, double dt) {
  const SceneResult r = RunScene(scene + " -ts_central_check off -ts_dt " + std::to_string(dt * 1e6) + "e-6");
  return r.failed ? -1 : std::sqrt(r.observed.v_max2);
}

// The exact step is where the program itself turns unstable, with springs and beta.
TEST(StepBound, TheExactStepIsWhereTheRunTurns) {
  for (double beta : {0.0, 2e-5}) {
    Body body;
    body.Make("-mesh box -mesh_box_cells 2,2,1 -mesh_box_size 2,2,1");
    body.SplitAll();
    body.Build();
    const double dt = CriticalStep(LargestW2(body.tables, std::vector<char>(body.tables.x.size(), 1)), beta);
    char damping[40];
    std::snprintf(damping, sizeof damping, " -damping_beta %g", beta);
    const std::string scene = std::string(
                                  "-mesh box -mesh_box_cells 2,2,1 -mesh_box_size 2,2,1 -interfaces j "
                                  "-interface_j_on all -boundaries xmax -boundary_xmax_traction 1e3,2e3,5e2 "
                                  "-tables p -table_p_type ricker -table_p_frequency 2000 -table_p_delay 2e-4 "
                                  "-boundary_xmax_table p -device cpu") +
                              kRock + damping + (beta > 0 ? " -ts_max_steps 3000" : " -ts_max_steps 1000");
    EXPECT_LT(SpeedAfter(scene, 0.999 * dt), 1);
    EXPECT_GT(SpeedAfter(scene, 1.001 * dt), 10);
  }
}

}  // namespace
}  // namespace cdem
