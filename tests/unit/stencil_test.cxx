// Stencils against the loops over elements and springs, and their steps against those of the reference way.
#include "../support/run_scene.hpp"
#include "forces/stencil.hpp"

#include <cmath>

namespace cdem {
namespace {

const char *const kJoints = " -interfaces j -interface_j_on all -interface_j_law elastic";

std::string Box(const std::string &cells, const std::string &more) {
  return "-mesh box -mesh_box_size 5,4,3 -mesh_box_cells " + cells + kRock + " -gravity 0,0,-9.81 " +
         "-boundaries zmin,zmax,xmax -boundary_zmin_fix xyz -boundary_zmax_traction 1e5,0,2e5 -boundary_zmax_table r "
         "-boundary_xmax_displacement 0.001,0,0 -boundary_xmax_components x -boundary_xmax_table r -tables r "
         "-table_r_type ramp -table_r_delay 0.01 " +
         more;
}

/// Scenes of congruent elements: every shape and form, springs, several parts.
std::vector<std::string> CongruentScenes() {
  std::vector<std::string> scenes;
  for (const char *shape : {"hex", "tet", "wedge"})
    for (const char *joints : {"", kJoints})
      scenes.push_back(Box("10,8,6", std::string("-mesh_box_shape ") + shape + joints));
  scenes.push_back(Box("10,8,6", "-mesh_box_shape wedge -block_element bbar"));
  scenes.push_back(Box("10,8,6", "-block_element bbar"));
  scenes.push_back(Box("10,8,6", "-block_element onepoint"));
  scenes.push_back(Box("40,2,2", ""));
  return scenes;
}

/// Internal forces by a plan [n_owned][3]; of nodes without a position 0.
std::vector<double> ForcesByPlan(const StencilPlan &plan, int pad, const std::vector<double> &u) {
  std::vector<double> f(u.size(), 0.0);
  for (const StencilClass &c : plan.classes)
    for (int p = c.begin; p < c.end; ++p) {
      const int place = plan.position[p], lane = (p - c.begin) % pad;
      for (int k = 0; place >= 0 && k < c.count; ++k) {
        const StencilEntry &entry = plan.entry[c.first + k];
        const std::int64_t other =
            c.list < 0 ? place + entry.offset
                       : plan.list[c.list + static_cast<std::int64_t>(p - c.begin - lane) * c.count + k * pad + lane];
        for (int m = 0; m < 9; ++m) f[3 * plan.node[place] + m / 3] += entry.block[m] * u[3 * plan.node[other] + m % 3];
      }
    }
  return f;
}

TEST(Stencil, IsTheLoopsOverElementsAndSprings) {
  for (const std::string &scene : CongruentScenes())
    for (int pad : {8, 32}) {
      SCOPED_TRACE(scene);
      std::unique_ptr<Simulation> s = SetUpScene(scene + " -ts_max_steps 1", PETSC_COMM_SELF);
      ASSERT_TRUE(s);
      const Tables &t = s->tables();
      StencilPlan plan;
      const std::string why = PlanStencil(t, pad, true, &plan);
      ASSERT_EQ(why, "");
      std::vector<double> u(t.x.size()), wanted(u.size(), 0.0);
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = 1e-3 * std::sin(1.0 + 17.0 * i * i);
      std::vector<ElementHistories> elements = StartElements(t);
      std::vector<SpringHistory> springs = StartSprings(t);
      HostElements(t, u.data(), nullptr, 0, 0, elements, wanted.data());
      HostSprings(t, u.data(), nullptr, 0, springs, wanted.data());
      std::vector<char> moves(t.n_owned, 0);
      for (int place : plan.position)
        if (place >= 0) {
          EXPECT_FALSE(moves[plan.node[place]]) << "a node at two positions";
          moves[plan.node[place]] = 1;
        }
      int moving = 0;
      for (int i = 0; i < t.n_owned; ++i) {
        moving += moves[i];
        if (moves[i]) continue;
        EXPECT_EQ(t.x[3 * i + 2], 0.0) << "only the base stands still";
        for (int k = 0; k < 3; ++k) wanted[3 * i + k] = 0;
      }
      EXPECT_EQ(moving, plan.moving);
      EXPECT_LT(RelativeDifference(ForcesByPlan(plan, pad, u), wanted), 1e-13);
    }
}

TEST(Stencil, FewRowsServeABox) {
  for (const auto &[cells, rows] : {std::pair{"20,20,20", 60}, {"40,10,10", 60}}) {
    std::unique_ptr<Simulation> s = SetUpScene(Box(cells, "-ts_max_steps 1"), PETSC_COMM_SELF);
    ASSERT_TRUE(s);
    StencilPlan plan;
    ASSERT_EQ(PlanStencil(s->tables(), 8, false, &plan), "");
    EXPECT_LT(static_cast<int>(plan.classes.size()), rows);
    int listed = 0;
    for (const StencilClass &c : plan.classes) listed += c.list < 0 ? 0 : c.end - c.begin;
    EXPECT_LT(20 * listed, plan.moving) << "nearly all neighbours are found by offsets";
  }
}

TEST(Stencil, StepsAreThoseOfTheReferenceWay) {
  for (const char *damping : {"", " -damping_alpha 5", " -damping_alpha 5 -damping_beta 1e-5"})
    for (const std::string &body : CongruentScenes()) {
      const std::string scene = body + damping + " -ts_max_steps 301";
      SCOPED_TRACE(scene);
      const SceneResult reference = RunScene(scene + " -central_way reference", PETSC_COMM_SELF),
                        stencil = RunScene(scene + " -central_way stencil", PETSC_COMM_SELF),
                        again = RunScene(scene + " -central_way stencil -ts_central_batch 7", PETSC_COMM_SELF);
      EXPECT_LT(RelativeDifference(stencil.u, reference.u), 1e-10);
      EXPECT_LT(RelativeDifference(stencil.v, reference.v), 1e-10);
      EXPECT_TRUE(SameBits(stencil.u, again.u) && SameBits(stencil.v, again.v)) << "batches do not matter";
    }
}

TEST(Stencil, ToleratesRoundingAndNoMore) {
  for (const auto &[jitter, taken] : {std::pair{"1e-13", true}, {"1e-8", false}}) {
    std::unique_ptr<Simulation> s =
        SetUpScene(Box("10,10,10", std::string("-ts_max_steps 1 -mesh_box_jitter ") + jitter), PETSC_COMM_SELF);
    ASSERT_TRUE(s);
    StencilPlan plan;
    EXPECT_EQ(PlanStencil(s->tables(), 8, false, &plan).empty(), taken) << jitter;
  }
}

// By its name a scene goes this way whatever it costs: the same forces without anything alike.
TEST(Stencil, GoesAnyLinearSceneWhenTold) {
  const std::string scene = Box("6,5,4", "-mesh_box_jitter 0.1 -ts_max_steps 101");
  const SceneResult reference = RunScene(scene, PETSC_COMM_SELF),
                    stencil = RunScene(scene + " -central_way stencil", PETSC_COMM_SELF);
  EXPECT_LT(RelativeDifference(stencil.u, reference.u), 1e-10);
  EXPECT_LT(RelativeDifference(stencil.v, reference.v), 1e-10);
}

TEST(Stencil, NotOfWhatIsNotLinearOrAlike) {
  for (const char *block : {"-block_law drucker_prager -block_cohesion 1e6 -block_friction 30 -block_tension 1e5",
                            "-interfaces j -interface_j_on all -interface_j_law brittle -interface_j_tension 1e5 "
                            "-interface_j_cohesion 1e6 -interface_j_friction 30",
                            "-mesh_box_jitter 0.1", "-block_young_scatter normal:0.1"}) {
    SCOPED_TRACE(block);
    const std::string scene = Box("8,8,8", std::string(block) + " -ts_max_steps 1");
    std::unique_ptr<Simulation> s = SetUpScene(scene, PETSC_COMM_SELF);
    if (!s) continue;
    EXPECT_EQ(s->backend().WayOfStep().name, "reference");
    EXPECT_NE(s->backend().WayOfStep().text.find("not stencil: "), std::string::npos);
  }
}

}  // namespace
}  // namespace cdem
