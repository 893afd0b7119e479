// Small scenes whose critical step is known from a dense stiffness matrix.
#pragma once
#include "small_body.hpp"

namespace cdem {

/// A box of a few elements.
struct CriticalScene {
  const char *name, *mesh;
  double b;            ///< stiffness factor of springs on all faces; 0: joined
  double poisson;      ///< of the blocks
  double least;        ///< bound over exact step, at least
  double beta = 0;     ///< s
  double soft = 1;     ///< Young's modulus of every second cell over that of the first
  bool fixed = false;  ///< all nodes at z = 0
  const char *element = "full";
};

inline const char *const kCubes = "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3";
inline const char *const kJitter = "-mesh box -mesh_box_cells 3,3,3 -mesh_box_size 3,3,3 -mesh_box_jitter 0.3";
inline const char *const kPair = "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2";

inline const CriticalScene kCriticalScenes[] = {
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
    {"8 cubes, split, contrast 1e6", kPair, 20, 0.25, 0.5, 0, 1e-6},
    {"27 cubes, joined, contrast 1e6", kCubes, 0, 0.25, 0.6, 0, 1e-6},
    {"8 cubes, split, fixed, beta = 1e-5", kPair, 20, 0.25, 0.5, 1e-5, 1, true},
    {"48 tetrahedra, jitter, bbar, nu = .45, contrast 100",
     "-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 2,2,2 -mesh_box_shape tet -mesh_box_jitter 0.2", 0, 0.45, 0.2, 0,
     0.01, false, "bbar"},
};

/// Prescribes the velocity of all components that are not free.
inline void HoldComponents(const std::vector<char> &free_dof, Tables *tables) {
  NodeRecords records;
  records.of_node.assign(tables->n_owned, -1);
  for (int i = 0; i < tables->n_owned; ++i) {
    int kind = 0;
    for (int k = 0; k < 3; ++k)
      if (!free_dof[3 * static_cast<std::size_t>(i) + k]) kind |= kVelocity << (2 * k);
    if (kind == 0) continue;
    records.of_node[i] = records.n++;
    records.kind.push_back(static_cast<std::uint8_t>(kind));
  }
  if (records.n > 0) tables->records = records;
}

/// Builds it; which components are free, [n_local][3]. Those that are not have a velocity prescribed.
inline std::vector<char> MakeScene(const CriticalScene &scene, Body *body) {
  body->Make(scene.mesh);
  body->materials = {MakeMaterial(1e10, scene.poisson, 2500), MakeMaterial(scene.soft * 1e10, scene.poisson, 2500)};
  for (PetscInt c = 0; c < body->mesh.n_cells; ++c) body->mesh.cell_region[c] = static_cast<int>(c % 2);
  for (Material &m : body->materials) {
    m.element = scene.element;
    if (m.element == "spring")
      m.law = BlockLaws::Find("spring"), m.param[SpringBlock::kTension] = 1e30, m.param[SpringBlock::kCohesion] = 1e30;
  }
  if (scene.b > 0) body->SplitAll();
  body->joints[0].stiffness_factor = scene.b;
  body->Build();
  EXPECT_LT(body->nodes.n_local, 150);
  body->tables.beta = scene.beta;
  std::vector<char> free_dof(body->tables.x.size(), 1);
  for (std::size_t i = 0; scene.fixed && i < free_dof.size(); ++i) free_dof[i] = body->tables.x[i / 3 * 3 + 2] > 0;
  HoldComponents(free_dof, &body->tables);
  return free_dof;
}

}  // namespace cdem
