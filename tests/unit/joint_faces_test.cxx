// Faces that discs take: the two sides of a joint come apart; ranks do not matter.
#include "../support/run_scene.hpp"
#include "joints/network.hpp"
#include "mesh_make.hpp"

#include "core/small.hpp"

#include <fstream>
#include <numeric>
#include <set>
#include <unistd.h>

namespace cdem {
namespace {

/// A file with one disc through everything: centre (3, 3, 3).
class OneDisc {
 public:
  OneDisc(double dip, double direction, double diameter = 100)
      : path_(testing::TempDir() + "cdem_disc_" + std::to_string(getpid()) + ".txt") {
    std::ofstream(path_) << "3 3 3 " << dip << " " << direction << " " << diameter << "\n";
    NormalOf(dip, direction, normal);
  }
  ~OneDisc() { std::remove(path_.c_str()); }
  std::string Options() const { return " -joints j -joint_j_file " + path_; }
  double normal[3];

 private:
  std::string path_;
};

std::string Block(const std::string &shape, const std::string &jitter) {
  return "-mesh box -mesh_box_cells 6,6,6 -mesh_box_size 6,6,6 -mesh_box_shape " + shape + " -mesh_box_jitter " +
         jitter;
}

struct Case {
  const char *shape, *jitter;
  double dip, direction;
};
constexpr Case kCases[] = {{"hex", "0", 30, 70},    {"hex", "0.2", 30, 70},   {"tet", "0", 30, 70},
                           {"tet", "0.12", 30, 70}, {"wedge", "0.1", 30, 70}, {"hex", "0.2", 0, 0},
                           {"tet", "0.12", 0, 0},   {"tet", "0.12", 38, 200}, {"hex", "0", 45, 90},
                           {"tet", "0", 0, 0}};

double Mean(const Mesh &mesh, PetscInt cell, const double origin[3], const double normal[3]) {
  double sum = 0;
  const int corners = Info(mesh.cell_shape[cell]).corners;
  for (int a = 0; a < corners; ++a)
    for (int k = 0; k < 3; ++k) sum += normal[k] * (mesh.X(mesh.Corners(cell)[a])[k] - origin[k]) / corners;
  return sum;
}

// No way from one side to the other, over faces that are not taken or over nodes; and motion: pulled along its normal,
// a joint without strength leaves the lower side at rest.
TEST(JointSides, ComeApart) {
  const double centre[3] = {3, 3, 3};
  for (const Case &c : kCases) {
    const OneDisc disc(c.dip, c.direction);
    const double *n = disc.normal;
    char pull[100];
    std::snprintf(pull, sizeof pull, " -boundary_zmax_velocity %.17g,%.17g,%.17g", 0.01 * n[0], 0.01 * n[1],
                  0.01 * n[2]);
    const std::string scene =
        Block(c.shape, c.jitter) + kRock + disc.Options() +
        " -interfaces i -interface_i_on joints:j -interface_i_law brittle -interface_i_tension 0 -interface_i_cohesion "
        "0 "
        "-interface_i_friction 0 -boundaries zmin,zmax -boundary_zmin_fix xyz -damping_beta 1e-4 -device cpu "
        "-ts_max_time 0.1" +
        pull;
    const auto s = SetUpScene(scene, PETSC_COMM_SELF);
    ASSERT_TRUE(s) << scene;
    const Mesh &mesh = s->mesh();
    std::vector<PetscInt> part(mesh.n_cells);
    std::iota(part.begin(), part.end(), 0);
    const auto root = [&](PetscInt cell) {
      while (part[cell] != cell) cell = part[cell] = part[part[cell]];
      return cell;
    };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      if (mesh.faces[f].cell[1] >= 0 && s->face_interface()[f] < 0)
        part[root(mesh.faces[f].cell[0])] = root(mesh.faces[f].cell[1]);
    std::set<PetscInt> roots[2];
    std::vector<int> side(s->nodes().n_local, -1);
    int bridges = 0, back = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {  // faces that the pull closes
      if (s->face_interface()[f] < 0) continue;
      const Face &face = mesh.faces[f];
      const ShapeInfo &info = Info(mesh.cell_shape[face.cell[0]]);
      double x[4][3], area[4][3], sum = 0;
      for (int j = 0; j < info.face_size[face.local[0]]; ++j)
        std::copy_n(mesh.X(mesh.Corners(face.cell[0])[info.face[face.local[0]][j]]), 3, x[j]);
      FaceVectors(info.face_size[face.local[0]], x, area);
      for (int j = 0; j < info.face_size[face.local[0]]; ++j) sum += Dot(area[j], n);
      back += sum * (Mean(mesh, face.cell[0], centre, n) > 0 ? -1 : 1) < -1e-12;
    }
    for (PetscInt cell = 0; cell < mesh.n_cells; ++cell) {
      const int above = Mean(mesh, cell, centre, n) > 0;
      roots[above].insert(root(cell));
      for (int a = 0; a < Info(mesh.cell_shape[cell]).corners; ++a) {
        int &of_node = side[s->nodes().Corners(cell)[a]];
        bridges += of_node >= 0 && of_node != above;
        of_node = above;
      }
    }
    EXPECT_EQ(roots[0].size(), 1u);
    EXPECT_EQ(roots[1].size(), 1u);
    EXPECT_NE(*roots[0].begin(), *roots[1].begin());
    EXPECT_EQ(bridges, 0);
    EXPECT_EQ(s->nodes().n_blocks, 2);

    ASSERT_EQ(s->Solve(), 0);
    const double *u, *v;
    const Histories *history;
    ASSERT_EQ(s->backend().Download(&u, &v, &history), 0);
    double most = 0, least = 1;  // over the pull
    for (PetscInt i = 0; i < s->nodes().n_owned; ++i) {
      if (side[i])
        least = std::min(least, Dot(u + 3 * i, n) / 0.001);
      else
        most = std::max(most, std::sqrt(Dot(u + 3 * i, u + 3 * i)) / 0.001);
    }
    const JointSet &set = s->joint_sets()[0];
    std::printf(
        "%s, jitter %s, dip %g: %lld faces, area %.3f times that of the disc inside; lower side moved by %.2g, "
        "upper side by at least %.4f of the pull; %d faces lean back\n",
        c.shape, c.jitter, c.dip, static_cast<long long>(set.taken_faces), set.AreaRatio(), most, least, back);
    EXPECT_LT(most, 0.02);
    EXPECT_GT(least, 0.97);  // what is left of the swing in 0.1 s
  }
}

using CellFace = std::pair<PetscInt, int>;

/// The whole set of faces, from all ranks.
std::set<CellFace> Gather(const Mesh &mesh, const std::vector<PetscInt> &faces) {
  std::vector<PetscInt> mine, all;
  for (PetscInt f : faces) {
    mine.push_back(mesh.cell_global[mesh.faces[f].cell[0]]);
    mine.push_back(mesh.faces[f].local[0]);
  }
  int size, n = static_cast<int>(mine.size());
  MPI_Comm_size(mesh.comm, &size);
  std::vector<int> counts(size), begin(size + 1, 0);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, mesh.comm);
  std::partial_sum(counts.begin(), counts.end(), begin.begin() + 1);
  all.resize(begin[size]);
  MPI_Allgatherv(mine.data(), n, MPIU_INT, all.data(), counts.data(), begin.data(), MPIU_INT, mesh.comm);
  std::set<CellFace> faces_of_all;
  for (std::size_t i = 0; i < all.size(); i += 2) faces_of_all.insert({all[i], static_cast<int>(all[i + 1])});
  return faces_of_all;
}

const char *const kSets =
    " -joints a,b,c -joint_dip 50 -joint_dip_direction 300 -joint_fisher 15 -joint_a_p32 0.6 -joint_a_diameter "
    "power:2.5,1,6 -joint_b_p32 0.3 -joint_b_diameter lognormal:3,1 -joint_c_count 0.02 -joint_c_diameter uniform:1,4";

struct Made {
  std::string discs;
  std::vector<std::set<CellFace>> faces;
  std::vector<double> figures;
};

void MakeSets(MPI_Comm comm, const std::string &options, Made *made) {
  Mesh mesh;
  std::vector<JointSet> sets;
  std::vector<FaceSet> faces;
  std::vector<std::string> remarks;
  ASSERT_EQ(Make(comm, options, &mesh), 0);
  ASSERT_EQ(PetscOptionsClear(nullptr), 0);
  ASSERT_EQ(PetscOptionsInsertString(nullptr, options.c_str()), 0);
  Options reader(comm);
  ASSERT_EQ(CreateJointSets(mesh, reader, &sets, &faces, &remarks), 0);
  made->discs = DiscTable(sets);
  for (const FaceSet &set : faces) made->faces.push_back(Gather(mesh, set.faces));
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const JointSet &s = sets[i];
    EXPECT_EQ(s.taken_faces, static_cast<std::int64_t>(made->faces[i].size()));
    for (double figure : {s.volume, s.disc_area, s.taken_area, static_cast<double>(s.inner_faces)})
      made->figures.push_back(figure);
  }
}

TEST(JointRanks, DoNotMatter) {
  for (const std::string &mesh :
       {Block("hex", "0.2"), Block("tet", "0.12"), Block("wedge", "0.1"), Block("tet", "0.12") + " -dm_refine 1"}) {
    Made alone, together;
    ASSERT_NO_FATAL_FAILURE(MakeSets(PETSC_COMM_SELF, mesh + kSets, &alone));
    ASSERT_NO_FATAL_FAILURE(MakeSets(PETSC_COMM_WORLD, mesh + kSets, &together));
    EXPECT_EQ(alone.discs, together.discs);
    EXPECT_EQ(alone.faces, together.faces);
    EXPECT_EQ(alone.figures, together.figures);
    EXPECT_GT(alone.faces[0].size(), 50u);
  }
}

TEST(JointRanks, DoNotMatterForTheRun) {
  ExpectRanksDoNotMatter(
      Block("tet", "0.12") + kRock + kSets +
      " -interfaces a,b,c -interface_a_on joints:a -interface_b_on joints:b -interface_c_on joints:c "
      "-interface_law brittle -interface_tension 1e4 -interface_cohesion 1e4 -interface_friction 30 "
      "-interface_b_law elastic -gravity 0,0,-9.81 -boundaries zmin -boundary_zmin_fix xyz "
      "-ts_max_steps 300 -device cpu");
}

// A face of a region's rim belongs to no set within it, and a disc ends where its region does.
TEST(JointSides, StayWithinTheirRegion) {
  Mesh mesh;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh " + MeshFolder() + "/mixed_41a.msh", &mesh), 0);
  ASSERT_GT(mesh.regions.size(), 1u);
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    std::vector<JointSet> sets;
    std::vector<FaceSet> faces;
    std::vector<std::string> remarks;
    ASSERT_EQ(PetscOptionsClear(nullptr), 0);
    ASSERT_EQ(PetscOptionsInsertString(nullptr, ("-joints a -joint_a_p32 5 -joint_a_dip 20 -joint_a_dip_direction 30 "
                                                 "-joint_a_fisher 0 -joint_a_diameter fixed:0.5 -joint_a_within " +
                                                 mesh.regions[r])
                                                    .c_str()),
              0);
    Options reader(PETSC_COMM_SELF);
    ASSERT_EQ(CreateJointSets(mesh, reader, &sets, &faces, &remarks), 0);
    EXPECT_NEAR(sets[0].volume, Volume(mesh, static_cast<int>(r)), 1e-10 * sets[0].volume);
    EXPECT_FALSE(faces[0].faces.empty());
    for (PetscInt f : faces[0].faces)
      for (PetscInt cell : mesh.faces[f].cell) EXPECT_EQ(mesh.cell_region[cell], static_cast<int>(r));
  }
  EXPECT_EQ(PetscOptionsClear(nullptr), 0);
}

}  // namespace
}  // namespace cdem
