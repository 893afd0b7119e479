// CreateMesh against PETSc's closures and against itself: on several ranks (mpirun -np 3 cdem_unit --gtest_filter=Mesh*)
// every local part is compared with the whole mesh on one.
#include "mesh_make.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace cdem {
namespace {

const std::string kBox = "-mesh box -mesh_box_cells 4,3,5 -mesh_box_size 2,3,2.5 -mesh_box_origin -1,0.1,7 ";

using CellFace = std::pair<PetscInt, int>;  // global cell, local face

CellFace Key(const Mesh &mesh, PetscInt face) {
  return {mesh.cell_global[mesh.faces[face].cell[0]], mesh.faces[face].local[0]};
}

std::set<std::array<double, 3>> Corners(const Mesh &mesh, PetscInt cell, int local) {
  std::set<std::array<double, 3>> corners;
  const ShapeInfo &info = Info(mesh.cell_shape[cell]);
  for (int k = 0; k < info.face_size[local]; ++k) {
    const double *x = mesh.X(mesh.Corners(cell)[info.face[local][k]]);
    corners.insert({x[0], x[1], x[2]});
  }
  return corners;
}

std::vector<double> Positions(const Mesh &mesh, PetscInt cell) {
  std::vector<double> x;
  for (int k = 0; k < Info(mesh.cell_shape[cell]).corners; ++k) {
    for (int d = 0; d < 3; ++d) x.push_back(mesh.X(mesh.Corners(cell)[k])[d]);
  }
  return x;
}

class MeshCase : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::string options = GetParam();
    const std::size_t at = options.find("FILE/");
    if (at != std::string::npos) options.replace(at, 4, MeshFolder());
    ASSERT_EQ(Make(PETSC_COMM_WORLD, options, &mesh), PETSC_SUCCESS);
    ASSERT_EQ(Make(PETSC_COMM_SELF, options, &whole), PETSC_SUCCESS);
    for (PetscInt c = 0; c < mesh.n_cells; ++c) local[mesh.cell_global[c]] = c;
  }
  Mesh mesh, whole;
  std::map<PetscInt, PetscInt> local;  // global -> local cell
};

TEST_P(MeshCase, CornersAreThoseOfPetsc) {
  PetscInt cells[2], vertices[2];
  PetscSection section;
  Vec coordinates;
  const PetscScalar *x;
  ASSERT_FALSE(DMPlexGetHeightStratum(mesh.dm, 0, &cells[0], &cells[1]));
  ASSERT_FALSE(DMPlexGetDepthStratum(mesh.dm, 0, &vertices[0], &vertices[1]));
  ASSERT_FALSE(DMGetCoordinateSection(mesh.dm, &section));
  ASSERT_FALSE(DMGetCoordinatesLocal(mesh.dm, &coordinates));
  ASSERT_FALSE(VecGetArrayRead(coordinates, &x));
  std::multiset<std::vector<double>> petsc, ours;
  for (PetscInt c = cells[0]; c < cells[1]; ++c) {
    PetscInt n, *closure = nullptr, corner[8], corners = 0;
    DMPolytopeType type;
    ASSERT_FALSE(DMPlexGetCellType(mesh.dm, c, &type));
    ASSERT_FALSE(DMPlexGetTransitiveClosure(mesh.dm, c, PETSC_TRUE, &n, &closure));
    for (PetscInt i = 0; i < n; ++i) {
      if (closure[2 * i] >= vertices[0] && closure[2 * i] < vertices[1]) corner[corners++] = closure[2 * i];
    }
    ASSERT_FALSE(DMPlexRestoreTransitiveClosure(mesh.dm, c, PETSC_TRUE, &n, &closure));
    ASSERT_FALSE(DMPlexInvertCell(type, corner));  // PETSc's order to gmsh's
    std::vector<double> positions;
    for (PetscInt k = 0; k < corners; ++k) {
      PetscInt offset;
      ASSERT_FALSE(PetscSectionGetOffset(section, corner[k], &offset));
      positions.insert(positions.end(), x + offset, x + offset + 3);
    }
    petsc.insert(positions);
  }
  ASSERT_FALSE(VecRestoreArrayRead(coordinates, &x));
  for (PetscInt c = 0; c < mesh.n_cells; ++c) ours.insert(Positions(mesh, c));
  EXPECT_EQ(petsc, ours);
}

TEST_P(MeshCase, CellsAreRightSideOut) {
  for (PetscInt c = 0; c < mesh.n_cells; ++c) {
    const ShapeInfo &info = Info(mesh.cell_shape[c]);
    double x[kMaxCorners][3], volumes[kMaxCorners], centre[3] = {0, 0, 0};
    for (int k = 0; k < info.corners; ++k) {
      for (int d = 0; d < 3; ++d) x[k][d] = mesh.X(mesh.Corners(c)[k])[d];
      for (int d = 0; d < 3; ++d) centre[d] += x[k][d] / info.corners;
    }
    EXPECT_GT(CornerVolumes(mesh.cell_shape[c], x, volumes), 0);
    for (int j = 0; j < info.faces; ++j) {
      double y[4][3], vectors[4][3], out = 0;
      const int size = info.face_size[j];
      for (int k = 0; k < size; ++k) std::copy_n(x[info.face[j][k]], 3, y[k]);
      FaceVectors(size, y, vectors);
      for (int k = 0; k < size; ++k) {
        for (int d = 0; d < 3; ++d) out += vectors[k][d] * (y[0][d] - centre[d]);
      }
      EXPECT_GT(out, 0) << "face " << j << " of a " << info.name;
    }
  }
}

TEST_P(MeshCase, FacesAreListedOnceAndInOrder) {
  std::set<std::pair<PetscInt, int>> seen;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face &face = mesh.faces[f];
    if (f > 0) {
      EXPECT_LT(Key(mesh, f - 1), Key(mesh, f));
    }
    EXPECT_TRUE(seen.insert({face.cell[0], face.local[0]}).second);
    if (face.cell[1] < 0) continue;
    EXPECT_TRUE(seen.insert({face.cell[1], face.local[1]}).second);
    EXPECT_LT(mesh.cell_global[face.cell[0]], mesh.cell_global[face.cell[1]]);
    EXPECT_EQ(Corners(mesh, face.cell[0], face.local[0]), Corners(mesh, face.cell[1], face.local[1]));
  }
  std::size_t all = 0;
  for (Shape shape : mesh.cell_shape) all += Info(shape).faces;
  EXPECT_EQ(seen.size(), all);
}

TEST_P(MeshCase, EveryCellHasOneOwner) {
  int rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  EXPECT_EQ(mesh.n_global, whole.n_global);
  std::vector<int> count(mesh.n_global, 0);
  for (PetscInt c = 0; c < mesh.n_owned; ++c) ++count[mesh.cell_global[c]];
  MPI_Allreduce(MPI_IN_PLACE, count.data(), static_cast<int>(count.size()), MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  for (int n : count) EXPECT_EQ(n, 1);
  for (PetscInt c = 0; c < mesh.n_cells; ++c) EXPECT_EQ(mesh.cell_owner[c] == rank, c < mesh.n_owned);
  EXPECT_TRUE(std::is_sorted(mesh.cell_global.begin(), mesh.cell_global.begin() + mesh.n_owned));
  EXPECT_TRUE(std::is_sorted(mesh.cell_global.begin() + mesh.n_owned, mesh.cell_global.end()));
  if (!mesh.cell_sf) {
    EXPECT_EQ(mesh.n_owned, mesh.n_cells);
    return;
  }
  std::vector<PetscInt> number(mesh.cell_global);
  std::fill(number.begin() + mesh.n_owned, number.end(), -1);
  ASSERT_FALSE(PetscSFBcastBegin(mesh.cell_sf, MPIU_INT, number.data(), number.data(), MPI_REPLACE));
  ASSERT_FALSE(PetscSFBcastEnd(mesh.cell_sf, MPIU_INT, number.data(), number.data(), MPI_REPLACE));
  EXPECT_EQ(number, mesh.cell_global);
}

// Corner order, coordinates, faces and names of a part are those of the whole; the stars of owned vertices are complete.
TEST_P(MeshCase, PartsAgreeWithTheWhole) {
  std::set<PetscInt> owned_vertices;  // of the whole
  for (PetscInt c = 0; c < mesh.n_cells; ++c) {
    const PetscInt g = mesh.cell_global[c];
    ASSERT_EQ(mesh.cell_shape[c], whole.cell_shape[g]);
    EXPECT_EQ(mesh.cell_region[c], whole.cell_region[g]);
    EXPECT_EQ(Positions(mesh, c), Positions(whole, g));
    if (c < mesh.n_owned) owned_vertices.insert(whole.Corners(g), whole.Corners(g) + Info(mesh.cell_shape[c]).corners);
  }
  const auto touches = [&](PetscInt g) {
    const PetscInt *corner = whole.Corners(g), n = Info(whole.cell_shape[g]).corners;
    return std::any_of(corner, corner + n, [&](PetscInt v) { return owned_vertices.count(v) > 0; });
  };
  for (PetscInt g = 0; g < whole.n_cells; ++g) EXPECT_EQ(touches(g), local.count(g) > 0) << g;

  std::map<CellFace, const Face *> faces;  // of the whole
  for (std::size_t f = 0; f < whole.faces.size(); ++f) faces[Key(whole, f)] = &whole.faces[f];
  for (const Face &face : mesh.faces) {
    if (face.cell[1] < 0) continue;
    const auto found = faces.find({mesh.cell_global[face.cell[0]], face.local[0]});
    ASSERT_NE(found, faces.end());
    EXPECT_EQ(found->second->cell[1], mesh.cell_global[face.cell[1]]);
    EXPECT_EQ(found->second->local[1], face.local[1]);
  }
  for (const Face &face : whole.faces) {  // a face whose cells are both here has both of them
    if (face.cell[1] >= 0 && local.count(face.cell[0]) && local.count(face.cell[1])) {
      const PetscInt c = local[face.cell[0]];
      EXPECT_TRUE(std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face &f) {
        return f.cell[0] == c && f.local[0] == face.local[0] && f.cell[1] == local[face.cell[1]];
      }));
    }
  }

  EXPECT_EQ(mesh.regions, whole.regions);
  EXPECT_EQ(mesh.surfaces, whole.surfaces);
  EXPECT_EQ(mesh.point_sets, whole.point_sets);
  ASSERT_EQ(mesh.surface_faces.size(), mesh.surfaces.size());
  for (std::size_t s = 0; s < mesh.surfaces.size(); ++s) {
    std::set<std::set<std::array<double, 3>>> here, expected;
    for (PetscInt f : mesh.surface_faces[s]) here.insert(Corners(mesh, mesh.faces[f].cell[0], mesh.faces[f].local[0]));
    for (PetscInt f : whole.surface_faces[s]) {
      const Face &face = whole.faces[f];
      if (local.count(face.cell[0]) || (face.cell[1] >= 0 && local.count(face.cell[1]))) {
        expected.insert(Corners(whole, face.cell[0], face.local[0]));
      }
    }
    EXPECT_EQ(here, expected) << mesh.surfaces[s];
    EXPECT_EQ(here.size(), mesh.surface_faces[s].size());
  }
  for (std::size_t s = 0; s < mesh.point_sets.size(); ++s) {
    std::set<std::array<double, 3>> here, all;
    for (PetscInt v : mesh.set_vertices[s]) here.insert({mesh.X(v)[0], mesh.X(v)[1], mesh.X(v)[2]});
    for (PetscInt v : whole.set_vertices[s]) all.insert({whole.X(v)[0], whole.X(v)[1], whole.X(v)[2]});
    EXPECT_EQ(here.size(), mesh.set_vertices[s].size());
    EXPECT_TRUE(std::includes(all.begin(), all.end(), here.begin(), here.end()));
    for (std::size_t v = 0; v < mesh.vertex_x.size() / 3; ++v) {
      const std::array<double, 3> x{mesh.X(v)[0], mesh.X(v)[1], mesh.X(v)[2]};
      EXPECT_EQ(all.count(x), here.count(x));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MeshCase,
                         testing::Values(kBox, kBox + "-mesh_box_jitter 0.3",
                                         kBox + "-mesh_box_shape wedge -mesh_box_jitter 0.15",
                                         kBox + "-mesh_box_shape tet -mesh_box_jitter 0.15", "-mesh FILE/mixed_41a.msh",
                                         "-mesh FILE/mixed_22b.msh", "-mesh FILE/mixed_41b.msh -dm_refine 1",
                                         kBox + "-mesh_box_shape wedge -dm_refine 1",
                                         kBox + "-mesh_box_shape tet -dm_refine 1",
                                         kBox + "-mesh_box_jitter 0.2 -dm_refine 1 -petscpartitioner_type simple",
                                         "-mesh box -mesh_box_cells 2,1,1 -mesh_box_size 1,1,1"));

TEST(MeshBox, SidesStayAndInnerVerticesMove) {
  for (const char *shape : {"hex", "wedge", "tet"}) {
    Mesh straight, moved, other;
    const std::string box = kBox + "-mesh_box_shape " + shape;
    ASSERT_EQ(Make(PETSC_COMM_SELF, box, &straight), PETSC_SUCCESS);
    ASSERT_EQ(Make(PETSC_COMM_SELF, box + " -mesh_box_jitter 0.1", &moved), PETSC_SUCCESS);
    ASSERT_EQ(Make(PETSC_COMM_SELF, box + " -mesh_box_jitter 0.1 -seed 7", &other), PETSC_SUCCESS);
    EXPECT_NEAR(Volume(straight, 0), 15, 1e-12);
    EXPECT_NEAR(Volume(moved, 0), 15, 1e-12);
    const double lower[3] = {-1, 0.1, 7}, upper[3] = {1, 3.1, 9.5}, h[3] = {0.5, 1, 0.5};
    ASSERT_EQ(straight.vertex_x.size(), moved.vertex_x.size());
    for (std::size_t v = 0; v < straight.vertex_x.size() / 3; ++v) {
      bool inside = true;
      for (int d = 0; d < 3; ++d) inside = inside && straight.X(v)[d] > lower[d] && straight.X(v)[d] < upper[d];
      for (int d = 0; d < 3; ++d) {
        EXPECT_EQ(moved.X(v)[d] != straight.X(v)[d], inside);
        EXPECT_EQ(moved.X(v)[d] != other.X(v)[d], inside);
        EXPECT_LE(std::abs(moved.X(v)[d] - straight.X(v)[d]), 0.1001 * h[d]);
      }
    }
    const std::vector<std::string> sides{"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
    EXPECT_EQ(straight.surfaces, sides);
    for (int side = 0; side < 6; ++side) {
      const int d = side / 2, per_quad = shape[0] == 't' || (shape[0] == 'w' && d == 2) ? 2 : 1;
      const int cells[3] = {4, 3, 5};
      EXPECT_EQ(static_cast<int>(straight.surface_faces[side].size()), per_quad * 60 / cells[d]);
      for (PetscInt f : straight.surface_faces[side]) {
        const Face &face = straight.faces[f];
        EXPECT_EQ(face.cell[1], -1);
        for (const auto &x : Corners(straight, face.cell[0], face.local[0])) {
          EXPECT_NEAR(x[d], side % 2 ? upper[d] : lower[d], 1e-15);
        }
      }
    }
  }
}

TEST(MeshBox, CellsCountAlongXFirst) {
  Mesh mesh;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh box -mesh_box_cells 4,3,2 -mesh_box_size 4,3,2", &mesh), PETSC_SUCCESS);
  for (PetscInt c = 0; c < mesh.n_cells; ++c) {
    const double *x = mesh.X(mesh.Corners(c)[0]);
    EXPECT_EQ(x[0] + 4 * (x[1] + 3 * x[2]), static_cast<double>(c));
  }
}

}  // namespace
}  // namespace cdem
