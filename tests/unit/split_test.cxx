// Nodes, blocks, springs and masses of split boxes, counted by hand.
#include "small_body.hpp"

#include <numeric>
#include <set>

namespace cdem {
namespace {

const std::string kBox = "-mesh box -mesh_box_cells 4,3,2 -mesh_box_size 2,3,1 ";

int Springs(const Tables &tables) {
  int n = 0;
  for (const SpringTable &t : tables.springs) n += t.n;
  return n;
}
double SpringArea(const Tables &tables) {
  double sum = 0;
  for (const SpringTable &t : tables.springs) sum += std::accumulate(t.area.begin(), t.area.begin() + t.n, 0.0);
  return sum;
}
double Sum(const std::vector<double> &values) { return std::accumulate(values.begin(), values.end(), 0.0); }

void ExpectCounts(const Body &body, PetscInt nodes, PetscInt blocks, int springs, double area) {
  EXPECT_EQ(body.nodes.n_global, nodes);
  EXPECT_EQ(body.nodes.n_owned, nodes);
  EXPECT_EQ(body.nodes.n_local, nodes);
  EXPECT_EQ(body.nodes.n_blocks, blocks);
  EXPECT_EQ(Springs(body.tables), springs);
  EXPECT_NEAR(SpringArea(body.tables), area, 1e-14 * area);
  for (const SpringTable &t : body.tables.springs) {
    EXPECT_EQ(std::count(t.counted.begin(), t.counted.end(), 1), t.n);
    EXPECT_EQ(t.n_pad % kPad, 0);
    for (int i = 0; i < t.n_pad; ++i) {
      EXPECT_NE(t.a[i], t.b[i]);
      EXPECT_EQ(body.nodes.vertex[t.a[i]], body.nodes.vertex[t.b[i]]);
      EXPECT_GT(t.area[i], 0);
      double n2 = 0;
      for (int k = 0; k < 3; ++k) n2 += std::pow(t.normal[static_cast<std::size_t>(k) * t.n_pad + i], 2);
      EXPECT_NEAR(n2, 1, 1e-15);
    }
  }
}

TEST(Split, JoinedBoxes) {
  const PetscInt parts[] = {1, 6, 2};
  int i = 0;
  for (const char *shape : {"hex", "tet", "wedge"}) {
    Body body;
    body.Make(kBox + "-mesh_box_shape " + shape);
    body.Build();
    ExpectCounts(body, 5 * 4 * 3, 1, 0, 0);
    EXPECT_EQ(body.mesh.n_cells, parts[i++] * 24);
    EXPECT_TRUE(body.tables.springs.empty());
  }
}

TEST(Split, EveryElementABlock) {
  // faces inside: 3 x 3 x 2 of area 1/2, 4 x 2 x 2 of 1/4, 4 x 3 x 1 of 1/2
  const double area = 18 * 0.5 + 16 * 0.25 + 12 * 0.5;
  Body hex, tet, wedge;
  hex.Make(kBox);
  hex.SplitAll();
  hex.Build();
  ExpectCounts(hex, 8 * 24, 24, 4 * 46, area);
  // a cell of six tetrahedra has six faces inside, of area |d| |e| / 2 with all edges of the box from its diagonal
  tet.Make(kBox + "-mesh_box_shape tet");
  tet.SplitAll();
  tet.Build();
  const double edge[3] = {0.5, 1, 0.5}, diagonal[3] = {0.5, 1, 0.5};
  double inside = 0;
  for (int d = 0; d < 3; ++d) {
    double along[3] = {0, 0, 0}, c[3];
    along[d] = edge[d];
    Cross(along, diagonal, c);
    inside += 2 * 0.5 * std::sqrt(Dot(c, c));  // between the edge d and the diagonal, and the face opposite
  }
  ExpectCounts(tet, 4 * 144, 144, 3 * (2 * 46 + 6 * 24), area + 24 * inside);
  wedge.Make(kBox + "-mesh_box_shape wedge");
  wedge.SplitAll();
  wedge.Build();
  ExpectCounts(wedge, 6 * 48, 48, 4 * (18 + 16 + 24) + 3 * 2 * 12, area + 24 * std::sqrt(1.25) * 0.5);
}

TEST(Split, ThroughTheSceneOptions) {
  const std::string scene = kBox + kRock + " -ts_max_steps 1 -device cpu -interfaces j -interface_j_on ";
  for (const char *on : {"all", "inside:box"}) {
    const auto s = SetUpScene(scene + on, PETSC_COMM_SELF);
    ASSERT_NE(s, nullptr);
    EXPECT_EQ(s->nodes().n_global, 8 * 24);
    EXPECT_EQ(s->nodes().n_blocks, 24);
    EXPECT_EQ(Springs(s->tables()), 4 * 46);
  }
  const auto s =
      SetUpScene("-mesh " + MeshFolder() + "/mixed_41a.msh -interfaces fault" + kRock + " -ts_max_steps 1 -device cpu",
                 PETSC_COMM_SELF);
  ASSERT_NE(s, nullptr);
  EXPECT_EQ(s->nodes().n_blocks, 2);
  EXPECT_EQ(s->nodes().n_global, static_cast<PetscInt>(s->mesh().vertex_x.size() / 3) + 9);
  EXPECT_EQ(Springs(s->tables()), 16);
  EXPECT_NEAR(SpringArea(s->tables()), 1, 1e-14);
}

TEST(Split, AFaultThroughTheBody) {
  Body body;
  body.Make(kBox);
  body.Split([&](PetscInt a, PetscInt b) { return (body.CentreX(a) < 1) != (body.CentreX(b) < 1); });
  body.Build();
  ExpectCounts(body, 5 * 4 * 3 + 4 * 3, 2, 4 * 6, 3);
}

TEST(Split, AFaultThatEndsInsideHasNoSpringAtItsTip) {
  Body body;
  body.Make(kBox);
  const auto y = [&](PetscInt cell) {
    double centre[3];
    body.Centre(cell, centre);
    return centre[1];
  };
  // the plane x = 1 for y < 2: four faces; its tip is the line x = 1, y = 2 of three vertices
  body.Split(
      [&](PetscInt a, PetscInt b) { return (body.CentreX(a) < 1) != (body.CentreX(b) < 1) && y(a) < 2 && y(b) < 2; });
  body.Build();
  ExpectCounts(body, 60 + 2 * 3, 1, 4 * 4 - 4, 2 - 4 * 0.125);
  for (int i = 0; i < body.tables.springs[0].n; ++i)
    EXPECT_LT(body.mesh.X(body.nodes.vertex[body.tables.springs[0].a[i]])[1], 1.5);
}

TEST(Split, ATableForEveryLaw) {
  Body body;
  body.Make(kBox);
  body.joints.resize(2);
  body.joints[1].law = JointLaws::Find("brittle");
  body.joints[1].broken = true;
  for (std::size_t f = 0; f < body.mesh.faces.size(); ++f)
    if (body.mesh.faces[f].cell[1] >= 0) body.face_interface[f] = static_cast<int>(f % 2);
  body.Build();
  ASSERT_EQ(body.tables.springs.size(), 2u);
  EXPECT_EQ(Springs(body.tables), 4 * 46);
  EXPECT_TRUE(body.tables.springs[0].state.empty());
  const SpringTable &brittle = body.tables.springs[1];
  ASSERT_EQ(static_cast<int>(brittle.state.size()), brittle.n_pad);
  for (int i = 0; i < brittle.n; ++i) EXPECT_EQ(brittle.state[i], kTensionLost | kCohesionLost);
}

TEST(Split, MassesAndAreasOfDistortedBodies) {
  for (const char *shape : {"hex", "tet", "wedge"})
    for (bool split : {false, true}) {
      SCOPED_TRACE(shape);
      Body body;
      body.Make(kBox + "-mesh_box_jitter 0.25 -mesh_box_shape " + shape);
      if (split) body.SplitAll();
      body.Build();
      EXPECT_NEAR(Sum(body.tables.mass), 6 * 2500, 1e-13 * 6 * 2500);
      for (int i = 0; i < body.tables.n_owned; ++i) {
        EXPECT_GT(body.tables.mass[i], 0);
        EXPECT_EQ(body.tables.inverse_mass[i], 1 / body.tables.mass[i]);
      }
      for (const SpringTable &t : body.tables.springs)
        for (int i = 0; i < t.n; ++i) {
          EXPECT_GT(t.area[i], 0);
          EXPECT_GT(t.kn[i], t.ks[i]);
          // from a's block to b's
          const Face &face = body.mesh.faces[t.face[i]];
          double from[3], to[3], along = 0;
          body.Centre(face.cell[0], from);
          body.Centre(face.cell[1], to);
          for (int k = 0; k < 3; ++k) along += (to[k] - from[k]) * t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
          EXPECT_GT(along, 0);
        }
    }
}

TEST(Split, NodesAreNumberedByCellAndCorner) {
  Body body;
  body.Make(kBox + "-mesh_box_shape wedge");
  body.Split([&](PetscInt a, PetscInt b) { return (body.CentreX(a) < 1) != (body.CentreX(b) < 1); });
  body.Build();
  std::set<PetscInt> seen;
  for (PetscInt c = 0; c < body.mesh.n_cells; ++c)
    for (int a = 0; a < 6; ++a) {
      const PetscInt node = body.nodes.Corners(c)[a];
      if (seen.insert(node).second) {
        EXPECT_EQ(node, static_cast<PetscInt>(seen.size()) - 1);
        EXPECT_EQ(body.nodes.global[node], node);
      }
      EXPECT_EQ(body.nodes.vertex[node], body.mesh.Corners(c)[a]);
    }
  EXPECT_EQ(static_cast<PetscInt>(seen.size()), body.nodes.n_global);
}

TEST(Split, GlobalOffsetsCountWhatComesBefore) {
  Body body;
  body.Make(kBox);
  std::vector<PetscInt> count(body.mesh.n_owned);
  for (std::size_t c = 0; c < count.size(); ++c) count[c] = static_cast<PetscInt>(c * 7 % 5);
  std::vector<std::int64_t> before;
  std::int64_t total = -1, sum = 0;
  ASSERT_PETSC(GlobalOffsets(body.mesh, count, &before, &total));
  ASSERT_EQ(before.size(), count.size());
  for (std::size_t c = 0; c < count.size(); ++c) {
    EXPECT_EQ(before[c], sum);
    sum += count[c];
  }
  EXPECT_EQ(total, sum);
}

}  // namespace
}  // namespace cdem
