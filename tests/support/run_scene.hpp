// Runs a scene given as an option string inside a test, and keeps what the test compares.
#pragma once
#include "core/error.hpp"
#include "core/events.hpp"
#include "physics/law_options.hpp"
#include "simulation.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

/// Fails the test when a PETSc call fails.
#define ASSERT_PETSC(call) ASSERT_EQ(static_cast<int>(call), 0)

namespace cdem {

/// State at the end of a run.
struct SceneResult {
  std::vector<double> u, v;  ///< owned nodes, [n][3]
  std::vector<SpringHistory> history;
  std::vector<ElementHistories> elements;
  Observed observed;  ///< of this rank
  bool failed = false;
};

/// Registers what main registers, once per process.
inline PetscErrorCode RegisterOnce() {
  PetscFunctionBeginUser;
  static bool done = false;
  if (!done) {
    PetscCall(RegisterEvents());
    PetscCall(RegisterTSCentral());
    RegisterLawOptions();
    done = true;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Sets the option database to these options alone and sets the scene up.
inline std::unique_ptr<Simulation> SetUpScene(const std::string &options, MPI_Comm comm = PETSC_COMM_WORLD) {
  EXPECT_EQ(static_cast<int>(RegisterOnce()), 0);
  EXPECT_EQ(static_cast<int>(PetscOptionsClear(nullptr)), 0);
  EXPECT_EQ(static_cast<int>(PetscOptionsInsertString(nullptr, options.c_str())), 0);
  auto simulation = std::make_unique<Simulation>(comm);
  if (simulation->SetUp()) return nullptr;
  return simulation;
}

/// Runs a scene to its end. With global, u and v are those of all ranks in the order of the global node numbers.
inline SceneResult RunScene(const std::string &options, MPI_Comm comm = PETSC_COMM_WORLD, bool global = false) {
  SceneResult result;
  std::unique_ptr<Simulation> s = SetUpScene(options, comm);
  if (!s || s->Solve() || s->Finish()) {
    result.failed = true;
    ADD_FAILURE() << "the scene did not run: " << options;
    return result;
  }
  const double *u, *v;
  const Histories *history;
  StepArgs next;
  next.dt = s->dt();
  std::vector<double> schedule(3 * static_cast<std::size_t>(s->tables().n_tables), 0.0);
  EXPECT_EQ(static_cast<int>(s->backend().Observe(next, schedule.data(), &result.observed)), 0);
  EXPECT_EQ(static_cast<int>(s->backend().Download(&u, &v, &history)), 0);
  const std::size_t n = 3 * static_cast<std::size_t>(s->tables().n_owned);
  result.u.assign(u, u + n);
  result.v.assign(v, v + n);
  // without the padding, which backends leave as it falls
  for (std::size_t g = 0; g < history->elements.size(); ++g) {
    const ElementTable &t = s->tables().elements[g];
    const ElementHistories &all = history->elements[g];
    ElementHistories live;
    if (t.states > 0) live.state.assign(all.state.begin(), all.state.begin() + t.n);
    for (int k = 0; k < t.states; ++k) {
      const auto row = all.value.begin() + static_cast<std::ptrdiff_t>(k) * t.n_pad;
      live.value.insert(live.value.end(), row, row + t.n);
    }
    if (t.judged) live.broken_time.assign(all.broken_time.begin(), all.broken_time.begin() + t.n);
    result.elements.push_back(live);
  }
  for (std::size_t g = 0; g < history->springs.size(); ++g) {
    const SpringTable &t = s->tables().springs[g];
    SpringHistory live;
    if (!t.state.empty()) {
      live.state.assign(history->springs[g].state.begin(), history->springs[g].state.begin() + t.n);
      for (int k = 0; k < t.n_state; ++k) {
        const auto row = history->springs[g].values.begin() + static_cast<std::ptrdiff_t>(k) * t.n_pad;
        live.values.insert(live.values.end(), row, row + t.n);
      }
    }
    result.history.push_back(live);
  }
  if (!global) return result;
  for (std::vector<double> *field : {&result.u, &result.v}) {
    // every entry is non-zero on one rank alone, so the sum is that entry to the last bit
    std::vector<double> all(3 * static_cast<std::size_t>(s->nodes().n_global), 0.0);
    for (std::size_t i = 0; i < field->size(); ++i) all[3 * s->nodes().global[i / 3] + i % 3] = (*field)[i];
    EXPECT_EQ(MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, comm), 0);
    *field = all;
  }
  EXPECT_EQ(static_cast<int>(SumOverRanks(comm, &result.observed)), 0);
  return result;
}

/// True when both are equal to the last bit.
inline bool SameBits(const std::vector<double> &a, const std::vector<double> &b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// max |a - b| / max |b|.
inline double RelativeDifference(const std::vector<double> &a, const std::vector<double> &b) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::fabs(a[i] - b[i]));
    size = std::max(size, std::fabs(b[i]));
  }
  return size > 0 ? most / size : most;
}

// Scenes that several tests share.
inline const char *const kRock = " -block_young 1e10 -block_poisson 0.25 -block_density 2500";
inline const char *const kBrick =
    "-mesh box -mesh_box_cells 10,10,10 -mesh_box_size 10,10,10 -block_young 1e10 -block_poisson 0.25 -block_density "
    "2500 "
    "-gravity 0,0,-9.81 -boundaries zmin -boundary_zmin_fix xyz";
/// A fully jointed block that is struck and breaks: pulled and sheared at the top. [in] law: elastic, brittle or
/// softening; "brittle dilating" and "softening dilating" are pressed while they shear, so that they ride up.
inline std::string BreakingScene(const std::string &shape, const std::string &law = "brittle") {
  const std::string name = law.substr(0, law.find(' '));
  std::string strength;
  if (name != "elastic") strength = " -interface_j_tension 2e5 -interface_j_cohesion 4e5 -interface_j_friction 30";
  if (name == "softening") strength += " -interface_j_gi 5 -interface_j_gii 20";
  if (name != law) strength += " -interface_j_dilation 8 -interface_j_dilation_slip 5e-4";
  return "-mesh box -mesh_box_shape " + shape + " -mesh_box_cells 6,5,4 -mesh_box_size 6,5,4 -mesh_box_jitter 0.15" +
         kRock + " -interfaces j -interface_j_on all -interface_j_law " + name + strength +
         " -gravity 0,0,-9.81 -boundaries zmin,zmax -boundary_zmin_fix xyz -boundary_zmax_velocity " +
         (name == law ? "0.4,0.1,0.3" : "0.8,0.2,-0.1") +
         " -boundary_zmax_table pulse -tables pulse -table_pulse_type sine -table_pulse_frequency 40 -damping_beta "
         "2e-5";
}
inline const char *const kBreakingLaws[] = {"brittle", "brittle dilating", "softening", "softening dilating"};

inline const char *const kFailingLaws[] = {"drucker_prager", "mohr_coulomb", "breakage"};
/// A body whose base is held and whose top is struck: much of it fails, by this block law.
inline std::string FailingScene(const std::string &shape, const std::string &law) {
  std::string numbers = " -block_cohesion 3e5 -block_friction 30 -block_tension 1e5";
  if (law == "drucker_prager")
    numbers += " -block_cone middle -block_dilation 5 -block_gf 200 -block_residual_cohesion 1e5";
  if (law == "mohr_coulomb") numbers += " -block_dilation 10";
  if (law == "breakage") numbers += " -block_residual_friction 20";
  return "-mesh box -mesh_box_shape " + shape + " -mesh_box_cells 6,5,4 -mesh_box_size 6,5,4 -mesh_box_jitter 0.15" +
         kRock + " -block_law " + law + numbers +
         " -gravity 0,0,-9.81 -boundaries zmin,zmax -boundary_zmin_fix xyz -boundary_zmax_velocity 0.4,0.1,0.3 "
         "-boundary_zmax_table pulse -tables pulse -table_pulse_type sine -table_pulse_frequency 40";
}
/// Elements in whose history something stands.
inline int Touched(const SceneResult &result) {
  int touched = 0;
  for (const ElementHistories &table : result.elements)
    for (std::uint8_t state : table.state) touched += state != 0;
  return touched;
}
/// A joined block that is struck at the top: for element forms and block laws, which further options name.
inline std::string StruckScene(const std::string &shape, const std::string &block) {
  return "-mesh box -mesh_box_shape " + shape + " -mesh_box_cells 6,5,4 -mesh_box_size 6,5,4 -mesh_box_jitter 0.15" +
         kRock +
         " -gravity 0,0,-9.81 -boundaries zmin,zmax -boundary_zmin_fix xyz -boundary_zmax_velocity 0.4,0.1,0.3 "
         "-boundary_zmax_table pulse -tables pulse -table_pulse_type sine -table_pulse_frequency 40 " +
         block;
}

/// Blocks that break, and with them the interfaces of their faces, which are stronger than they are.
inline std::string ReleasingScene(const std::string &shape) {
  return FailingScene(shape, "breakage") +
         " -interfaces j -interface_j_on all -interface_j_law brittle -interface_j_tension 1e8 "
         "-interface_j_cohesion 1e9 -interface_j_friction 30 -block_release_interfaces";
}

/// Every element form of hexahedra, wedges and tetrahedra but `full`, with and without damping by stiffness.
inline std::vector<std::string> FormScenes() {
  std::vector<std::string> scenes;
  for (const char *damping : {"", " -damping_beta 2e-5"}) {
    for (const char *shape : {"hex", "wedge", "tet"})
      scenes.push_back(StruckScene(shape, std::string("-block_element bbar") + damping));
    scenes.push_back(StruckScene("hex", std::string("-block_element onepoint") + damping));
    scenes.push_back(StruckScene("hex", std::string("-block_law spring -block_tension 1e6 -block_cohesion 2e6 "
                                                    "-block_friction 30 -block_residual_friction 20") +
                                            damping));
  }
  return scenes;
}

/// A run on all ranks against the same run on each rank by itself: the same to the last bit.
inline void ExpectRanksDoNotMatter(const std::string &scene) {
  const std::string options = scene + " -deterministic";
  const SceneResult alone = RunScene(options, PETSC_COMM_SELF, true),
                    together = RunScene(options, PETSC_COMM_WORLD, true);
  ASSERT_FALSE(alone.failed || together.failed);
  EXPECT_GT(alone.observed.u_max2, 0);
  EXPECT_TRUE(SameBits(alone.u, together.u)) << RelativeDifference(together.u, alone.u);
  EXPECT_TRUE(SameBits(alone.v, together.v)) << RelativeDifference(together.v, alone.v);
  EXPECT_EQ(alone.observed.broken, together.observed.broken);
  EXPECT_EQ(alone.observed.springs, together.observed.springs);
  EXPECT_EQ(alone.observed.broken_elements, together.observed.broken_elements);
}

}  // namespace cdem
