// Assembled rows against the loops over elements and springs, and the exchange of their distribution, played on the host.
#include "../support/run_scene.hpp"
#include "forces/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

namespace cdem {
namespace {

const char *const kJoints = " -interfaces j -interface_j_on all -interface_j_law elastic";

/// Scenes that are linear: every shape and form, springs, several laws of mass.
std::vector<std::string> LinearScenes() {
  std::vector<std::string> scenes;
  for (const char *shape : {"hex", "tet", "wedge"}) {
    scenes.push_back(StruckScene(shape, ""));
    scenes.push_back(StruckScene(shape, kJoints));
  }
  scenes.push_back(StruckScene("wedge", "-block_element bbar"));
  scenes.push_back(StruckScene("hex", "-block_element bbar"));
  scenes.push_back(StruckScene("hex", "-block_element onepoint"));
  return scenes;
}

/// Displacements without a pattern [m].
std::vector<double> SomeDisplacements(std::size_t n) {
  std::vector<double> u(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = 1e-3 * std::sin(1.0 + 17.0 * i * i);
  return u;
}

TEST(Rows, AreTheLoopsOverElementsAndSprings) {
  for (const std::string &scene : LinearScenes()) {
    SCOPED_TRACE(scene);
    std::unique_ptr<Simulation> s = SetUpScene(scene + " -ts_max_steps 5", PETSC_COMM_SELF);
    ASSERT_TRUE(s);
    const Tables &t = s->tables();
    ASSERT_EQ(NoRows(t), "");
    const StiffnessRows rows = AssembleRows(t);
    const std::vector<double> u = SomeDisplacements(t.x.size());
    std::vector<double> wanted(u.size(), 0.0), got(u.size(), 0.0);
    std::vector<ElementHistories> elements = StartElements(t);
    std::vector<SpringHistory> springs = StartSprings(t);
    HostElements(t, u.data(), nullptr, 0, 0, elements, wanted.data());
    HostSprings(t, u.data(), nullptr, 0, springs, wanted.data());
    for (int i = 0; i < t.n_owned; ++i)
      for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) got[3 * i + a] += rows.block[9 * k + 3 * a + b] * u[3 * rows.column[k] + b];
    EXPECT_LT(RelativeDifference(got, wanted), 1e-13);
  }
}

TEST(Rows, NotOfWhatIsNotLinear) {
  for (const char *block : {"-block_law drucker_prager -block_cohesion 1e6 -block_friction 30 -block_tension 1e5",
                            "-block_law breakage -block_cohesion 1e6 -block_friction 30 -block_tension 1e5",
                            "-interfaces j -interface_j_on all -interface_j_law brittle -interface_j_tension 1e5 "
                            "-interface_j_cohesion 1e6 -interface_j_friction 30",
                            "-block_stress 1e5,1e5,1e5,0,0,0"}) {
    SCOPED_TRACE(block);
    std::unique_ptr<Simulation> s = SetUpScene(StruckScene("hex", block) + " -ts_max_steps 5", PETSC_COMM_SELF);
    ASSERT_TRUE(s);
    EXPECT_NE(NoRows(s->tables()), "");
  }
  std::unique_ptr<Simulation> s =
      SetUpScene(StruckScene("tet", "-block_element bbar -ts_max_steps 5"), PETSC_COMM_SELF);
  ASSERT_TRUE(s);
  EXPECT_NE(NoRows(s->tables()), "");
}

/// Forces by a plan: every block reads its own slots alone, which hold its own nodes and what the targets sent.
std::vector<double> ForcesByPlan(const RowPlan &plan, const std::vector<double> &u) {
  using P = RowPlan;
  const std::size_t threads = plan.threads;
  std::vector<double> slots(3 * static_cast<std::size_t>(plan.n_blocks) * P::kSlots, std::nan("")), f(u.size(), 0.0);
  auto at = [&](int block, int slot) { return &slots[3 * (static_cast<std::size_t>(block) * P::kSlots + slot)]; };
  for (int b = 0; b < plan.n_blocks; ++b)
    for (int i = 0; i < plan.own[b]; ++i) {
      const int node = plan.node[b * threads + P::kLanes * i];
      std::copy_n(&u[3 * node], 3, at(b, i));
      for (int k = 0; k < P::kTargets; ++k) {
        const int to = plan.target[(static_cast<std::size_t>(b) * P::kNodes + i) * P::kTargets + k];
        if (to < 0) break;
        EXPECT_TRUE(std::isnan(at(to >> 16, to & 0xffff)[0])) << "two nodes in one slot";
        EXPECT_LT((to & 0xffff) - plan.own[to >> 16], plan.halo[to >> 16]);
        EXPECT_EQ(plan.far[plan.far_start[to >> 16] + (to & 0xffff) - plan.own[to >> 16]], node);
        std::copy_n(&u[3 * node], 3, at(to >> 16, to & 0xffff));
      }
    }
  for (int b = 0; b < plan.n_blocks; ++b)  // what stands still is there from the start
    for (int i = plan.far_start[b] + plan.halo[b]; i < plan.far_start[b + 1]; ++i)
      std::copy_n(&u[3 * plan.far[i]], 3, at(b, plan.own[b] + i - plan.far_start[b]));
  for (int b = 0; b < plan.n_blocks; ++b)
    for (std::size_t t = 0; t < threads; ++t) {
      const int node = plan.node[b * threads + t];
      if (node < 0) continue;
      for (int s = 0; s < P::kCouplings; ++s) {
        const int slot = plan.slot[(static_cast<std::size_t>(b) * P::kCouplings + s) * threads + t];
        const double *w = at(b, slot);
        for (int m = 0; m < 9; ++m)
          f[3 * node + m / 3] +=
              plan.coefficient[(static_cast<std::size_t>(b) * P::kCouplings * 9 + 9 * s + m) * threads + t] * w[m % 3];
      }
    }
  return f;
}

TEST(Rows, BlocksReadWhatIsSentToThem) {
  for (const char *cells : {"1,1,1", "3,3,3", "10,10,10", "40,2,3"})
    for (int blocks : {1, 8, 16}) {
      SCOPED_TRACE(cells);
      std::unique_ptr<Simulation> s =
          SetUpScene(std::string("-mesh box -mesh_box_cells ") + cells + " -mesh_box_size 3,2,1 -mesh_box_jitter 0.1" +
                         kRock + " -boundaries zmin -boundary_zmin_fix xyz -ts_max_steps 1",
                     PETSC_COMM_SELF);
      ASSERT_TRUE(s);
      const StiffnessRows rows = AssembleRows(s->tables());
      RowPlan plan;
      const std::vector<char> still = StillNodes(s->tables());
      const int moving = static_cast<int>(std::count(still.begin(), still.end(), 0));
      EXPECT_LT(moving, s->tables().n_owned);
      const std::string why = PlanRows(rows, s->tables().x, still, blocks, &plan);
      if (moving > blocks * RowPlan::kNodes) {
        EXPECT_NE(why, "");
        continue;
      }
      ASSERT_EQ(why, "");
      // a block that has a halo has a node in thread 0 that others read: it keeps the barrier
      for (int b = 0; b < plan.n_blocks; ++b) {
        EXPECT_EQ(plan.halo[b] > 0,
                  plan.target[static_cast<std::size_t>(b) * RowPlan::kTargets * RowPlan::kNodes] >= 0);
        EXPECT_GE(plan.own[b], 1);
      }
      const std::vector<double> u = SomeDisplacements(s->tables().x.size());
      std::vector<double> wanted(u.size(), 0.0);
      std::vector<ElementHistories> elements = StartElements(s->tables());
      HostElements(s->tables(), u.data(), nullptr, 0, 0, elements, wanted.data());
      for (std::size_t i = 0; i < still.size(); ++i)
        if (still[i]) std::fill_n(&wanted[3 * i], 3, 0.0);  // nobody asks
      EXPECT_LT(RelativeDifference(ForcesByPlan(plan, u), wanted), 1e-13);
    }
}

// What sixteen lanes read together should lie in sixteen banks of shared memory; 1 is perfect, by chance it would be 3.
TEST(Rows, LanesReadFromDifferentBanks) {
  std::unique_ptr<Simulation> s = SetUpScene(std::string(kBrick) + " -ts_max_steps 1", PETSC_COMM_SELF);
  ASSERT_TRUE(s);
  RowPlan plan;
  ASSERT_EQ(PlanRows(AssembleRows(s->tables()), s->tables().x, StillNodes(s->tables()), 16, &plan), "");
  double turns = 0, reads = 0;
  for (int b = 0; b < plan.n_blocks; ++b)
    for (int c = 0; c < RowPlan::kCouplings; ++c)
      for (int t = 0; t < plan.threads; t += 16) {
        std::set<int> of_bank[16];
        for (int l = t; l < t + 16; ++l) {
          const int slot = plan.slot[(static_cast<std::size_t>(b) * RowPlan::kCouplings + c) * plan.threads + l];
          of_bank[slot % 16].insert(slot);
        }
        std::size_t most = 0;
        for (const std::set<int> &slots : of_bank) most = std::max(most, slots.size());
        turns += static_cast<double>(most);
        ++reads;
      }
  EXPECT_LT(turns / reads, 1.6);
  RecordProperty("turns", std::to_string(turns / reads));
  std::printf("    %.3f turns a read\n", turns / reads);
}

}  // namespace
}  // namespace cdem
