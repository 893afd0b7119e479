// The energy audit: its balance closes in every scene, and each term against a closed form.
#include "../support/audit_run.hpp"
#include "../support/quiet_scene.hpp"

#include <cmath>

namespace cdem {
namespace {

// Struck bodies of every law, form and damping at the default step: what is missing is rounding.
TEST(Balance, ClosesInEveryScene) {
  std::vector<std::string> scenes = FormScenes();
  for (const char *damping : {"", " -damping_beta 2e-5", " -damping_alpha 20 -damping_local 0.2"}) {
    for (const char *law : kFailingLaws)
      for (const char *shape : {"hex", "tet", "wedge"}) scenes.push_back(FailingScene(shape, law) + damping);
    scenes.push_back(FailingScene("tet", "mohr_coulomb") + " -block_element bbar" + damping);
    scenes.push_back(FailingScene("hex", "drucker_prager") + " -block_element onepoint" + damping);
    for (const char *law : kBreakingLaws) scenes.push_back(BreakingScene("hex", law) + damping);
  }
  scenes.push_back(QuietScene("hex", "-damping_beta 2e-5"));
  scenes.push_back(ReleasingScene("hex"));
  for (const std::string &scene : scenes) {
    SCOPED_TRACE(scene);
    const AuditRun run(scene + " -ts_max_steps 600 -device cpu");
    ASSERT_GT(run.rows.size(), 6u);
    EXPECT_GT(run.last.Scale(), 1);
    EXPECT_LT(run.WorstError(), 1e-11);
  }
}

// A run with everything at once: yielding, breaking, friction and all dampings.
TEST(Balance, HoldsWithEverythingAtOnce) {
  const std::string scene =
      BreakingScene("hex", "softening") +
      " -block_law drucker_prager -block_cohesion 2e5 -block_friction 30 -block_tension 1e5 -damping_alpha 3 "
      "-damping_local 0.05 -boundaries zmin,zmax,xmin -boundary_xmin_quiet -ts_max_steps 3000 -device cpu";
  const AuditRun run(scene);
  const Balance &b = run.last;
  for (const BalanceTerm &term : kBalanceTerms) std::printf("    %-14s %12.5g\n", term.name, term.value(b));
  for (double term : {b.sums.plastic, b.sums.friction, b.sums.fracture, b.sums.alpha, b.sums.beta, b.sums.local,
                      b.sums.quiet, b.sums.motion})
    EXPECT_GT(term, 1e-3 * b.Scale()) << "the scene must do all of it";
  EXPECT_LT(run.WorstError(), 1e-11);
}

// Where cracks open and close, the scheme's force has a corner within the step; the work over it falls with dt.
TEST(Balance, WorkAtCornersOfContactFallsWithTheStep) {
  const std::string scene = BreakingScene("hex") + " -damping_beta 0 -ts_max_time 0.02 -device cpu -ts_dt ";
  double before = 0;
  for (double dt : {6e-5, 1.5e-5, 3.75e-6}) {
    const AuditRun run(scene + std::to_string(dt * 1e6) + "e-6");
    EXPECT_LT(run.WorstError(), 1e-4);  // of the last step, which is cut
    const double share = std::fabs(run.last.sums.contact) / run.last.Scale();
    std::printf("    dt %.3g s: contact %.3g of the work done\n", dt, share);
    if (before > 0) {
      EXPECT_LT(share, 0.6 * before);
    }
    before = share;
  }
}

// The audit changes nothing of the run, to the last bit.
TEST(Balance, TheRunIsTheSameWithoutIt) {
  std::vector<std::string> scenes = FormScenes();
  for (const char *beta : {"", " -damping_beta 2e-5"}) {
    for (const char *law : kFailingLaws)
      for (const char *shape : {"hex", "tet", "wedge"}) scenes.push_back(FailingScene(shape, law) + beta);
    scenes.push_back(FailingScene("tet", "drucker_prager") + " -block_element bbar" + beta);
    scenes.push_back(FailingScene("wedge", "mohr_coulomb") + " -block_element bbar" + beta);
    scenes.push_back(FailingScene("hex", "breakage") + " -block_element onepoint" + beta);
    for (const char *law : kBreakingLaws) scenes.push_back(BreakingScene("tet", law) + beta);
    scenes.push_back(ReleasingScene("hex") + beta);
    for (const char *nodes : {" -damping_alpha 10", " -damping_alpha 3 -damping_local 0.2"}) {
      scenes.push_back(BreakingScene("hex", "brittle") + beta + nodes);
      scenes.push_back(QuietScene("hex") + beta + nodes);
    }
  }
  for (const std::string &scene : scenes) {
    SCOPED_TRACE(scene);
    const std::string steps = " -ts_max_steps 400 -device cpu";
    const SceneResult off = RunScene(scene + steps), on = RunScene(scene + steps + kAuditOn);
    EXPECT_TRUE(SameBits(on.u, off.u)) << RelativeDifference(on.u, off.u);
    EXPECT_TRUE(SameBits(on.v, off.v));
    for (std::size_t g = 0; g < off.elements.size(); ++g) {
      EXPECT_TRUE(SameBits(on.elements[g].value, off.elements[g].value));
      EXPECT_EQ(on.elements[g].state, off.elements[g].state);
    }
    for (std::size_t g = 0; g < off.history.size(); ++g)
      EXPECT_TRUE(SameBits(on.history[g].values, off.history[g].values));
  }
}

const char *const kTwoBlocks =
    "-mesh box -mesh_box_cells 1,1,2 -mesh_box_size 2,2,0.5 -block_young 1e11 -block_poisson 0 -block_density 1000 "
    "-interfaces j -interface_j_on all -interface_j_kn 1e10 -interface_j_ks 1e10 -boundaries zmin,zmax "
    "-boundary_zmin_fix xyz -device cpu ";

// A block pressed by p and drawn over another one by u: friction is p A tan(phi) times the slip.
TEST(Balance, FrictionIsForceTimesSlip) {
  const double p = 1e5, area = 4, speed = 0.02, time = 0.05, phi = 30;
  const AuditRun run(std::string(kTwoBlocks) +
                     "-interface_j_law brittle -interface_j_tension 0 -interface_j_cohesion 0 -interface_j_friction 30 "
                     "-interface_j_initial broken -boundary_zmax_pressure 1e5 -boundary_zmax_velocity 0.02,0,0 "
                     "-boundary_zmax_components xy -damping_alpha 5000 -ts_max_time 0.05");
  const double force = p * area * std::tan(phi * kDegree), slip = speed * time - force / (1e10 * area);
  EXPECT_NEAR(run.last.sums.friction, force * slip, 5e-3 * force * slip);
  EXPECT_NEAR(run.last.sums.fracture, 0, 1e-6 * force * slip);
}

// A face pulled apart until nothing holds: G_I A.
TEST(Balance, SofteningPulledApartTakesGi) {
  const AuditRun run(std::string(kTwoBlocks) +
                     "-interface_j_law softening -interface_j_tension 1e5 -interface_j_cohesion 2e5 "
                     "-interface_j_friction 30 -interface_j_gi 10 -interface_j_gii 40 -boundary_zmax_velocity 0,0,0.01 "
                     "-damping_alpha 300 -ts_max_time 0.05");
  EXPECT_NEAR(run.last.sums.fracture, 10 * 4, 1e-3 * 40);
  EXPECT_NEAR(run.last.sums.friction, 0, 1e-12);
}

// The same sheared under pressure: G_II A breaks, the rest rubs.
TEST(Balance, SofteningShearedTakesGii) {
  const AuditRun run(std::string(kTwoBlocks) +
                     "-interface_j_law softening -interface_j_tension 1e5 -interface_j_cohesion 2e5 "
                     "-interface_j_friction 30 -interface_j_gi 10 -interface_j_gii 40 -boundary_zmax_pressure 3e5 "
                     "-boundary_zmax_velocity 0.02,0,0 -boundary_zmax_components xy -damping_alpha 5000 -ts_max_time "
                     "0.1");
  EXPECT_NEAR(run.last.sums.fracture, 40 * 4, 0.02 * 160);
  const double slip = 0.02 * 0.1, friction = 3e5 * 4 * std::tan(30 * kDegree);
  EXPECT_NEAR(run.last.sums.friction, friction * slip, 0.03 * friction * slip);
}

// A brittle face pulled until it breaks sets free what it stores at its strength: T^2 / (2 K_n).
TEST(Balance, BrittleFaceSetsFreeWhatItStores) {
  const AuditRun run(
      std::string(kTwoBlocks) +
      "-interface_j_law brittle -interface_j_tension 1e5 -interface_j_cohesion 2e5 -interface_j_friction "
      "30 -boundary_zmax_velocity 0,0,0.001 -damping_alpha 300 -ts_max_time 0.03");
  EXPECT_NEAR(run.last.sums.fracture, 4 * 1e10 / (2 * 1e10), 0.01 * 2);
}

// A free body that drifts: E(t) = E(0) exp(-2 alpha t), of the scheme ((1 - alpha dt/2)/(1 + alpha dt/2))^(2n).
TEST(Balance, AlphaDampsADriftingBody) {
  const AuditRun run(
      "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1 -velocity 0.3,0,0 -damping_alpha 50 -ts_max_steps 400 "
      "-ts_dt 1e-5 -device cpu " +
      std::string(kRock));
  const double start = 0.5 * 5000 * 0.09, x = 50 * 1e-5 / 2;
  // the first step is half a kick; v(n-1/2).M v(n+1/2) lies between two half steps
  const double exact = start * std::exp(-2 * 50 * 400 * 1e-5);
  EXPECT_NEAR(run.last.sums.alpha, start - exact, 1e-3 * start);
  EXPECT_NEAR(run.last.sums.kinetic, exact, x * exact);
  EXPECT_EQ(run.last.sums.beta, 0);
}

// Two stiff blocks on their springs swing against each other: the energy falls by exp(-2 xi w t), xi = beta w / 2.
TEST(Balance, BetaDampsAnOscillator) {
  const double beta = 2e-5, w = std::sqrt(1e10 * 2 / 1000.0), time = 6.28318530717958648 / w * 10;
  char options[160];
  std::snprintf(options, sizeof options, " -damping_beta %g -ts_max_time %.15g", beta, time);
  const std::string scene =
      "-mesh box -mesh_box_cells 1,1,2 -mesh_box_size 1,1,2 -block_young 1e13 -block_poisson 0 -block_density 1000 "
      "-interfaces j -interface_j_on all -interface_j_law elastic -interface_j_kn 1e10 -interface_j_ks 1e10 "
      "-boundaries zmin,zmax -boundary_zmin_pressure 1e5 -boundary_zmax_pressure 1e5 -device cpu";
  const AuditRun run(scene + options);
  const double work = run.last.sums.loads;  // the pressure swings it about its balance, of p^2 A / (2 K) less
  const double swing = 0.5 * 1e10 / 1e10, left = std::exp(-beta * w * w * time);
  EXPECT_NEAR(run.last.sums.beta, swing * (1 - left), 0.03 * swing);
  EXPECT_GT(work, 0);
}

// A body that falls against local damping: the share of its weight times the way.
TEST(Balance, LocalDampingTakesItsShareOfTheWeight) {
  const AuditRun run(
      "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 2,1,1 -gravity 0,0,-9.81 -damping_local 0.3 -ts_max_steps 500 "
      "-device cpu " +
      std::string(kRock));
  EXPECT_GT(run.last.gravity, 0);
  EXPECT_NEAR(run.last.sums.local, 0.3 * run.last.gravity, 5e-3 * run.last.gravity);
}

// A cube of cohesion c without friction flows at 2 c: work 2 c A (u - u_elastic).
TEST(Balance, YieldingColumnDoesPlasticWork) {
  for (const char *law : {"mohr_coulomb", "drucker_prager -block_cone outer"}) {
    const AuditRun run(
        std::string(
            "-mesh box -mesh_box_cells 1,1,1 -mesh_box_size 1,1,1 -block_young 1e10 -block_poisson 0.25 -block_density "
            "1000 -block_cohesion 1e5 -block_friction 0 -boundaries zmin,zmax -boundary_zmin_fix "
            "z -boundary_zmax_velocity 0,0,-0.01 -boundary_zmax_components z -damping_alpha 100 "
            "-ts_max_time 0.05 -device cpu -block_law ") +
        law);
    const double elastic = 2e5 / 1e10, exact = 2e5 * (0.01 * 0.05 - elastic);
    EXPECT_NEAR(run.last.sums.plastic, exact, 0.01 * exact) << law;
  }
}

// A pulse comes in through the quiet foot of a column, is thrown back at its top and leaves: all of it is absorbed, and
// with 2 C v_in on the dashpots both their work and what they absorb are 2 rho c A integral of v_in^2 dt.
TEST(Balance, QuietFootAbsorbsThePulse) {
  const double density = 2500, speed = 2000, amplitude = 0.1, duration = 0.02;
  const AuditRun run(
      "-mesh box -mesh_box_cells 1,1,40 -mesh_box_size 1,1,40 -block_young 1e10 -block_poisson 0 -block_density 2500 "
      "-boundaries sides,zmin -boundary_sides_on xmin -boundary_sides_fix x -boundary_zmin_quiet "
      "-boundary_zmin_velocity 0,0,0.1 -boundary_zmin_table p -tables p -table_p_type file -table_p_file " +
      PulseFile(duration) + " -ts_max_time 0.1 -device cpu");
  const double exact =
      2 * density * speed * amplitude * amplitude * duration * 3 / 8;  // of sin^2: mean of sin^4 is 3/8
  EXPECT_NEAR(run.last.sums.wave, exact, 0.01 * exact);
  EXPECT_NEAR(run.last.sums.quiet, exact, 0.01 * exact);
  EXPECT_LT(run.last.Stored(), 1e-3 * exact);
  EXPECT_LT(run.WorstError(), 1e-11);
}

// Stages: relaxations that stop the motion, removal and a change of stiffness; what leaves is said, and the rest closes.
TEST(Balance, GoesThroughStages) {
  const std::string scene =
      "-mesh box -mesh_box_cells 4,4,4 -mesh_box_size 4,4,4 -gravity 0,0,-9.81 -boundaries zmin,zmax "
      "-boundary_zmin_fix xyz -boundary_zmax_pressure 1e5 -interfaces j -interface_j_on all -interface_j_law brittle "
      "-interface_j_tension 1e4 -interface_j_cohesion 1e5 -interface_j_friction 30 -stages rest,soft,shake "
      "-stage_rest_solve relax -stage_soft_solve relax -stage_soft_block_young 5e9 -stage_shake_boundary_zmax_pressure "
      "5e5 -stage_shake_solve dynamic -stage_shake_ts_max_steps 500 -device cpu -relax_ratio 1e-4 -relax_kinetic 1e-6" +
      std::string(kRock);
  for (const char *damping : {"kinetic", "local", "rayleigh", "combined"}) {
    SCOPED_TRACE(damping);
    const AuditRun run(scene + " -relax_damping " + damping);
    EXPECT_LT(run.WorstError(), 1e-10);
    EXPECT_NE(run.last.changed, 0);
    if (std::string(damping) == "kinetic") {
      EXPECT_GT(run.last.stops, 0);
    }
  }
}

// Run with mpirun -n 2 and -n 3 (ctest does).
TEST(BalanceRanks, DoNotMatter) {
  for (const std::string &scene :
       {BreakingScene("hex", "softening") + " -damping_alpha 3", FailingScene("wedge", "drucker_prager"),
        FailingScene("tet", "mohr_coulomb") + " -block_element bbar -damping_beta 2e-5",
        QuietScene("hex", "-damping_local 0.1")}) {
    SCOPED_TRACE(scene);
    const AuditRun alone(scene + " -ts_max_steps 300 -device cpu", PETSC_COMM_SELF),
        together(scene + " -ts_max_steps 300 -device cpu", PETSC_COMM_WORLD);
    EXPECT_EQ(alone.last.sums.kinetic, together.last.sums.kinetic);
    EXPECT_EQ(alone.last.sums.strain, together.last.sums.strain);
    EXPECT_EQ(alone.last.sums.spring, together.last.sums.spring);
    for (const BalanceTerm &term : kBalanceTerms)
      EXPECT_EQ(term.value(alone.last), term.value(together.last)) << term.name;
  }
}

}  // namespace
}  // namespace cdem
