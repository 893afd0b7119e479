// Quiet boundaries: the dashpots of a face, the step of a node, its energy balance, stability.
#include "small_body.hpp"

#include "loads/quiet.hpp"

namespace cdem {
namespace {

/// C of all faces of the outer boundary whose centre is in the plane axis = at, summed over their nodes.
void SumDashpots(const Body &body, const std::function<bool(const double x[3])> &on, double sum[6]) {
  std::fill_n(sum, 6, 0.0);
  int faces = 0;
  for (const Face &face : body.mesh.faces) {
    double x[4][3];
    const int size = FaceCorners(body.mesh, face, x);
    if (face.cell[1] >= 0 || !std::all_of(x, x + size, on)) continue;
    Dashpot d[4];
    ASSERT_EQ(FaceDashpots(body.mesh, body.nodes, body.materials, face, 0, d), size);
    for (int j = 0; j < size; ++j)
      for (int k = 0; k < 6; ++k) sum[k] += d[j].c[k];
    ++faces;
  }
  EXPECT_GT(faces, 0);
}

// On a plane of area A the dashpots add up to rho A (c_p n n^T + c_s (1 - n n^T)), whatever the mesh and the direction.
TEST(Quiet, DashpotsOfAPlaneAddUp) {
  for (const char *shape : {"hex", "tet", "wedge"}) {
    Body body;
    body.Make(
        std::string("-mesh box -mesh_box_cells 3,2,2 -mesh_box_size 3,2,2 -mesh_box_jitter 0.2 -mesh_box_shape ") +
        shape);
    const double t = 0.6, c = std::cos(t), s = std::sin(t);  // turned about y; the side x = 3 then has n = (c, 0, -s)
    std::vector<double> plain = body.mesh.vertex_x;
    body.Move([&](double x[3]) {
      const double old[3] = {x[0], x[1], x[2]};
      x[0] = c * old[0] + s * old[2];
      x[2] = -s * old[0] + c * old[2];
    });
    body.Build();
    double sum[6];
    SumDashpots(
        body, [&](const double x[3]) { return std::fabs(c * x[0] - s * x[2] - 3) < 1e-9; }, sum);
    const Material &m = body.materials[0];
    const double p = std::sqrt(m.density * (m.lambda() + 2 * m.mu())), q = std::sqrt(m.density * m.mu());
    const double n[3] = {c, 0, -s}, area = 4;
    const double exact[6] = {area * (q + (p - q) * n[0] * n[0]), area * q, area * (q + (p - q) * n[2] * n[2]), 0, 0,
                             area * (p - q) * n[0] * n[2]};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(sum[k], exact[k], 1e-12 * area * p) << shape << " " << k;
  }
}

// A face between two materials: each side has the impedances of its own element, at its own nodes. Regions that leave make
// such faces the boundary.
TEST(Quiet, DashpotsAreThoseOfTheElementBehind) {
  Body body;
  body.Make("-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1");
  body.mesh.cell_region[1] = 1;
  body.materials.push_back(MakeMaterial(3e9, 0.3, 1700));
  body.SplitAll();
  body.Build();
  int sides = 0;
  for (const Face &face : body.mesh.faces)
    for (int side = 0; face.cell[1] >= 0 && side < 2; ++side, ++sides) {
      Dashpot d[4];
      ASSERT_EQ(FaceDashpots(body.mesh, body.nodes, body.materials, face, side, d), 4);
      const Material &m = body.materials[body.mesh.cell_region[face.cell[side]]];
      const double p = std::sqrt(m.density * (m.lambda() + 2 * m.mu())), q = std::sqrt(m.density * m.mu());
      const PetscInt *corner = body.nodes.Corners(face.cell[side]);
      for (const Dashpot &dashpot : d) {
        EXPECT_NE(std::find(corner, corner + 8, dashpot.node), corner + 8);
        const double exact[6] = {p / 4, q / 4, q / 4, 0, 0, 0};
        for (int k = 0; k < 6; ++k) EXPECT_NEAR(dashpot.c[k], exact[k], 1e-12 * p) << "side " << side << " " << k;
      }
    }
  EXPECT_EQ(sides, 2);
}

/// Solves A x = b with pivots [3][3].
void Eliminate(double a[3][4]) {
  for (int k = 0; k < 3; ++k) {
    int best = k;
    for (int i = k; i < 3; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[best][k])) best = i;
    std::swap_ranges(a[k], a[k] + 4, a[best]);
    for (int i = 0; i < 3; ++i) {
      const double f = i == k ? 0 : a[i][k] / a[k][k];
      for (int j = k; j < 4; ++j) a[i][j] -= f * a[k][j];
    }
  }
}

// Against the equations as they are written, (M + h/2 (alpha M + C)) v = (M - h/2 (alpha M + C)) v_old + h F in the free
// components and v prescribed in the others, for all of the eight choices of these.
TEST(Quiet, AbsorbSolvesTheCentredEquations) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> entry(-1, 1);
  constexpr int kPlace[3][3] = {{kXX, kXY, kXZ}, {kXY, kYY, kYZ}, {kXZ, kYZ, kZZ}};
  for (int trial = 0; trial < 200; ++trial)
    for (int held = 0; held < 8; ++held) {
      const double m = 3.7, h = 0.31, alpha = trial % 2 ? 0.9 : 0;
      double r[3][3], c[6] = {}, v_old[3], f[3], given[3], v[3], a[3][4];
      for (auto &row : r)
        for (double &value : row) value = 3 * entry(random);
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
          for (int k = 0; k < 3; ++k) c[kPlace[i][j]] += r[k][i] * r[k][j];
      int kind = 0;
      const double keep = (1 - 0.5 * alpha * h) / (1 + 0.5 * alpha * h), kick = h / (1 + 0.5 * alpha * h);
      for (int k = 0; k < 3; ++k) {
        v_old[k] = entry(random), f[k] = entry(random), given[k] = entry(random);
        v[k] = keep * v_old[k] + kick * f[k] / m;
        if (held >> k & 1) kind |= (1 + k % 2) << (2 * k), v[k] = given[k];
      }
      for (int i = 0; i < 3; ++i) {
        a[i][3] = m * (1 - 0.5 * alpha * h) * v_old[i] + h * f[i];
        for (int j = 0; j < 3; ++j) {
          a[i][j] = 0.5 * h * c[kPlace[i][j]] + (i == j ? m * (1 + 0.5 * alpha * h) : 0);
          a[i][3] -= 0.5 * h * c[kPlace[i][j]] * v_old[j];
        }
        if (!(held >> i & 1)) continue;
        for (int j = 0; j < 3; ++j) a[i][j] = i == j;
        a[i][3] = given[i];
      }
      Eliminate(a);
      Absorb(c, 0.5 * kick / m, kind, v_old, v);
      for (int k = 0; k < 3; ++k) {
        if (held >> k & 1)
          EXPECT_EQ(v[k], given[k]);
        else
          EXPECT_NEAR(v[k], a[k][3] / a[k][k], 1e-13) << "held " << held;
      }
    }
}

/// A box on quiet sides, one of which holds x, with joints inside.
const std::string kQuietBox = std::string(
                                  "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_jitter 0.1 "
                                  "-interfaces j -interface_j_on all -interface_j_stiffness_factor 5 "
                                  "-boundaries zmin,xmax,ymin -boundary_zmin_quiet -boundary_xmax_quiet "
                                  "-boundary_ymin_fix x -device cpu -ts_max_steps 100000") +
                              kRock;

/// Random velocities at the start.
void Shake(Simulation &scene) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> entry(-1, 1);
  PetscScalar *v;
  ASSERT_PETSC(VecGetArray(scene.v(), &v));
  for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(scene.tables().n_owned); ++i) v[i] = entry(random);
  ASSERT_PETSC(VecRestoreArray(scene.v(), &v));
}

/// The scene with random velocities and a step of share times the exact critical one.
std::unique_ptr<Simulation> AtShare(double share) {
  const auto sizes = SetUpScene(kQuietBox, PETSC_COMM_SELF);
  EXPECT_NE(sizes, nullptr);
  const Tables &t = sizes->tables();
  std::vector<char> free_dof(t.x.size(), 1);
  for (std::size_t i = 0; i < free_dof.size(); i += 3) free_dof[i] = t.x[i + 1] > 0;
  const double dt = share * 2 / std::sqrt(LargestW2(t, free_dof));
  char step[80];
  std::snprintf(step, sizeof step, " -ts_central_check warn -ts_dt %.15g", dt);
  auto scene = SetUpScene(kQuietBox + step, PETSC_COMM_SELF);
  EXPECT_NE(scene, nullptr);
  Shake(*scene);
  return scene;
}

/// Advances by n steps of the usual dt.
void Go(Simulation &s, StepPlan &plan, PetscInt n) {
  plan.dt = s.dt();
  plan.n = n;
  ASSERT_PETSC(s.Advance(plan));
  plan.dt_old = plan.dt;
  plan.first = plan.offset = plan.first + n;
}

// Exact in the discrete equations: the energy form changes by -dt/2 v(n+1/2) . C (v(n) + v(n+1)) from n to n+1.
TEST(Quiet, EnergyFormLosesWhatTheDashpotsTake) {
  const auto s = AtShare(0.9);
  ASSERT_NE(s, nullptr);
  const Tables &t = s->tables();
  const NodeRecords &r = t.records;
  ASSERT_FALSE(r.quiet.empty());
  const double schedule[3] = {1, 1, 1};
  StepArgs next;
  next.dt = next.kick = s->dt();
  StepPlan plan;
  std::vector<std::vector<double>> v;  // half-step velocities
  std::vector<double> form;
  for (int step = 0; step < 400; ++step) {
    Go(*s, plan, 1);
    Observed now;
    ASSERT_PETSC(s->backend().Observe(next, schedule, &now));
    form.push_back(now.form);  // at u(step + 1)
    const PetscScalar *array;
    ASSERT_PETSC(VecGetArrayRead(s->v(), &array));
    v.emplace_back(array, array + 3 * t.n_owned);  // at step + 1/2
    ASSERT_PETSC(VecRestoreArrayRead(s->v(), &array));
  }
  double worst = 0;
  for (std::size_t n = 1; n + 1 < v.size(); ++n) {  // from u(n) to u(n+1)
    double taken = 0;
    for (int i = 0; i < t.n_owned; ++i) {
      const int row = r.of_node[i];
      if (row < 0 || r.quiet[row] < 0) continue;
      const std::size_t at = 3 * static_cast<std::size_t>(i);
      double mean[3], force[3];
      for (int k = 0; k < 3; ++k) mean[k] = 0.5 * v[n - 1][at + k] + v[n][at + k] + 0.5 * v[n + 1][at + k];
      cdem::Apply(&r.dashpot[6 * static_cast<std::size_t>(r.quiet[row])], mean, force);
      taken += 0.5 * s->dt() * Dot(&v[n][at], force);
    }
    worst = std::max(worst, std::fabs(form[n] - form[n - 1] + taken) / form[0]);
  }
  std::printf("    balance to %.1e of the energy; %.1f %% of it is left after %zu steps\n", worst,
              100 * form.back() / form[0], form.size());
  EXPECT_LE(worst, 1e-13);
  EXPECT_LT(form.back(), 0.5 * form[0]);
}

// The dashpots do not change the critical step: at .99 of the exact one of the body without them all motion is taken up.
TEST(Quiet, StableAt99PercentOfTheCriticalStep) {
  const auto s = AtShare(0.99);
  ASSERT_NE(s, nullptr);
  const double schedule[3] = {1, 1, 1};
  StepArgs next;
  next.dt = next.kick = s->dt();
  StepPlan plan;
  Go(*s, plan, 1);
  Observed now;
  ASSERT_PETSC(s->backend().Observe(next, schedule, &now));
  const double first = now.form;
  double before = first;
  for (int batch = 0; batch < 100; ++batch) {
    Go(*s, plan, 1000);
    ASSERT_PETSC(s->backend().Observe(next, schedule, &now));
    EXPECT_LE(now.form, before * (1 + 1e-12) + 1e-25 * first);
    before = now.form;
  }
  std::printf("    energy left after 1e5 steps: %.1e\n", before / first);
  EXPECT_GT(first, 0);
  EXPECT_LT(before, 1e-6 * first);
}

// First step (half a kick), equal steps and a change of the step, of a body without inner forces: node by node.
TEST(Quiet, HalfKickAndChangeOfStep) {
  const auto s = SetUpScene(std::string("-mesh box -mesh_box_cells 1,1,1 -mesh_box_size 2,2,2 -boundaries zmin "
                                        "-boundary_zmin_quiet -gravity 0,0,-9.81 -damping_alpha 3 -velocity 1,-2,0.5 "
                                        "-device cpu -ts_dt 1e-4 -ts_max_steps 10 -ts_central_check warn") +
                                " -block_young 1 -block_poisson 0.25 -block_density 2500",  // soft: hardly any stress
                            PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  const Tables &t = s->tables();
  const double c[3] = {std::sqrt(2500 * 0.4), std::sqrt(2500 * 0.4), std::sqrt(2500 * 1.2)};  // rho c_s, rho c_p
  double expected[2][3] = {{1, -2, 0.5}, {1, -2, 0.5}};                                       // on top, at the bottom
  StepPlan plan;
  const double dt[] = {1e-4, 1e-4, 0.3e-4};
  for (int step = 0; step < 3; ++step) {
    plan.dt = dt[step], plan.n = 1;
    ASSERT_PETSC(s->Advance(plan));
    const double h = 0.5 * (plan.dt_old + plan.dt), m = 2500, half = 0.5 * h;
    for (int place = 0; place < 2; ++place)
      for (int k = 0; k < 3; ++k) {
        const double drag = half * (3 * m + place * c[k]);  // A_j = 1 m^2
        double &v = expected[place][k];
        v = ((m - drag) * v + h * m * (k == 2 ? -9.81 : 0)) / (m + drag);
      }
    plan.dt_old = plan.dt, plan.first = ++plan.offset;
    const PetscScalar *v;
    ASSERT_PETSC(VecGetArrayRead(s->v(), &v));
    for (int i = 0; i < t.n_owned; ++i)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(v[3 * i + k], expected[t.x[3 * i + 2] == 0][k], 1e-10) << "step " << step << " component " << k;
    ASSERT_PETSC(VecRestoreArrayRead(s->v(), &v));
  }
}

// v(n) and the forces out of balance: an observation takes the same centred half step; dashpots are no unbalanced force.
TEST(Quiet, ObservationsTakeTheSameHalfStep) {
  const auto s = SetUpScene(kQuietBox + " -gravity 0,0,-9.81 -damping_alpha 3 -boundary_zmin_velocity 0.1,0.2,0.3",
                            PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  Shake(*s);
  const Tables &t = s->tables();
  StepPlan plan;
  Go(*s, plan, 50);
  const double schedule[3] = {1, 1, 1}, half = 0.5 * 3 * s->dt();
  StepArgs next;
  next.dt = s->dt();
  next.keep = (1 - half) / (1 + half), next.kick = s->dt() / (1 + half);
  next.gravity[2] = -9.81;
  const double *u, *v;
  const Histories *history;
  std::vector<double> now;
  ElementResults elements;
  SpringResults springs;
  Observed observed;
  ASSERT_PETSC(s->backend().Download(&u, &v, &history));
  const std::vector<double> before(v, v + 3 * t.n_owned), f = InternalForces(t, {u, u + t.x.size()});
  ASSERT_PETSC(ObserveOnHost(t, 1 << 30, u, v, *history, next, schedule, &elements, &springs, &now, &observed));
  Go(*s, plan, 1);
  ASSERT_PETSC(s->backend().Download(&u, &v, &history));
  double residual = 0, kinetic = 0, worst = 0;
  const NodeRecords &r = t.records;
  for (int i = 0; i < 3 * t.n_owned; ++i) {
    const double mean = 0.5 * (before[i] + v[i]), m = t.mass[i / 3];
    worst = std::max(worst, std::fabs(mean - now[i]));
    kinetic += 0.5 * m * mean * mean;
    if (t.x[i / 3 * 3 + 1] == 0 && i % 3 == 0) continue;
    double load = i % 3 == 2 ? -9.81 * m : 0;
    const int row = r.of_node[i / 3];
    for (int l = row < 0 ? 0 : r.load_start[row]; l < (row < 0 ? 0 : r.load_start[row + 1]); ++l)
      load += r.load[3 * l + i % 3];
    residual += std::fabs(load - f[i]);
  }
  EXPECT_LE(worst, 1e-14 * Largest(now));
  EXPECT_NEAR(observed.kinetic, kinetic, 1e-12 * kinetic);
  EXPECT_NEAR(observed.residual_sum, residual, 1e-12 * residual);
}

}  // namespace
}  // namespace cdem
