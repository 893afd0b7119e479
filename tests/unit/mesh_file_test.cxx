// Meshes from files: names, formats, and everything that can be wrong with them.
#include "core/error.hpp"
#include "mesh/gmsh_scan.hpp"
#include "mesh_make.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>

namespace cdem {
namespace {

TEST(MeshFile, FormatsAgree) {
  Mesh first;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh " + MeshFolder() + "/mixed_41a.msh", &first), PETSC_SUCCESS);
  for (const char *name : {"41b", "22a", "22b"}) {
    Mesh mesh;
    ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh " + MeshFolder() + "/mixed_" + name + ".msh", &mesh), PETSC_SUCCESS);
    EXPECT_EQ(mesh.cell_vertex, first.cell_vertex);
    EXPECT_EQ(mesh.cell_shape, first.cell_shape);
    EXPECT_EQ(mesh.cell_region, first.cell_region);
    EXPECT_EQ(mesh.regions, first.regions);
    EXPECT_EQ(mesh.surfaces, first.surfaces);
    EXPECT_EQ(mesh.surface_faces, first.surface_faces);
    EXPECT_EQ(mesh.point_sets, first.point_sets);
    EXPECT_EQ(mesh.set_vertices, first.set_vertices);
    ASSERT_EQ(mesh.vertex_x.size(), first.vertex_x.size());
    for (std::size_t i = 0; i < mesh.vertex_x.size(); ++i) EXPECT_NEAR(mesh.vertex_x[i], first.vertex_x[i], 1e-15);
  }
}

TEST(MeshFile, NamesComeFromTheFile) {
  Mesh mesh;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh " + MeshFolder() + "/mixed_41a.msh", &mesh), PETSC_SUCCESS);
  EXPECT_EQ(mesh.regions, (std::vector<std::string>{"soft_rock", "bricks", "cap"}));
  EXPECT_EQ(mesh.surfaces, (std::vector<std::string>{"bottom", "fault", "base_of_cap"}));
  EXPECT_EQ(mesh.point_sets, (std::vector<std::string>{"hinge", "tip"}));
  EXPECT_EQ(Mesh::Find(mesh.regions, "cap"), 2);
  EXPECT_EQ(Mesh::Find(mesh.regions, "lid"), -1);
  EXPECT_NEAR(Volume(mesh, 0), 1, 1e-12);
  EXPECT_NEAR(Volume(mesh, 1), 1, 1e-12);
  EXPECT_NEAR(Volume(mesh, 2), 0.8 / 3, 1e-12);
  for (PetscInt f : mesh.surface_faces[1]) {  // the fault is inside, between bricks and soft rock
    ASSERT_GE(mesh.faces[f].cell[1], 0);
    EXPECT_NE(mesh.cell_region[mesh.faces[f].cell[0]], mesh.cell_region[mesh.faces[f].cell[1]]);
  }
  ASSERT_EQ(mesh.set_vertices[1].size(), 1u);
  EXPECT_EQ(mesh.X(mesh.set_vertices[1][0])[2], 1.8);
  EXPECT_EQ(mesh.set_vertices[0].size(), 3u);
  for (PetscInt v : mesh.set_vertices[0]) EXPECT_EQ(mesh.X(v)[0], 1);
}

TEST(MeshFile, LinesStayWholeWhenRefined) {
  Mesh mesh;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-dm_refine 2 -mesh " + MeshFolder() + "/mixed_41a.msh", &mesh), PETSC_SUCCESS);
  EXPECT_EQ(mesh.set_vertices[0].size(), 9u);
  EXPECT_EQ(mesh.surface_faces[1].size(), 64u);
}

// A file of format 2.2 on disk for the time of a test: nodes "x y z", elements "type tags... corners".
class Msh {
 public:
  Msh &Names(const std::string &text) { return names_ = text, *this; }
  Msh &Nodes(std::vector<std::string> nodes) { return nodes_ = std::move(nodes), *this; }
  Msh &Elements(std::vector<std::string> elements) { return elements_ = std::move(elements), *this; }
  std::string Text() const {
    std::ostringstream out;
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    if (!names_.empty()) {
      out << "$PhysicalNames\n"
          << std::count(names_.begin(), names_.end(), '\n') << "\n"
          << names_ << "$EndPhysicalNames\n";
    }
    out << "$Nodes\n" << nodes_.size() << "\n";
    for (std::size_t i = 0; i < nodes_.size(); ++i) out << i + 1 << " " << nodes_[i] << "\n";
    out << "$EndNodes\n$Elements\n" << elements_.size() << "\n";
    for (std::size_t i = 0; i < elements_.size(); ++i) out << 10 * (i + 1) << " " << elements_[i] << "\n";
    out << "$EndElements\n";
    return out.str();
  }

 private:
  std::string names_;
  // Two tetrahedra on the triangle 1 2 3.
  std::vector<std::string> nodes_{"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1"};
  std::vector<std::string> elements_{"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 5"};
};

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string &bytes)
      : path_((std::filesystem::temp_directory_path() / ("cdem_mesh_" + std::to_string(getpid()) + ".msh")).string()) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::string &path() const { return path_; }

 private:
  std::string path_;
};

std::string last_error;
PetscErrorCode Remember(MPI_Comm, int, const char *, const char *, PetscErrorCode code, PetscErrorType type,
                        const char *message, void *) {
  if (type == PETSC_ERROR_INITIAL)
    last_error = (code == PETSC_ERR_USER_INPUT ? "" : "not a user's error: ") + std::string(message);
  return code;
}

// The message of the error that these options end with; "" if they do not.
std::string ErrorOf(const std::string &options) {
  Mesh mesh;
  last_error.clear();
  (void)PetscPushErrorHandler(Remember, nullptr);
  const PetscErrorCode code = Make(PETSC_COMM_SELF, options, &mesh);
  (void)PetscPopErrorHandler();
  return code ? last_error : "";
}

std::string ErrorOfFile(const std::string &bytes) {
  const TemporaryFile file(bytes);
  std::string error = ErrorOf("-mesh " + file.path());
  const std::string begin = "mesh '" + file.path() + "'";
  EXPECT_EQ(error.empty() ? begin : error.substr(0, begin.size()), begin);
  return error.empty() ? "" : error.substr(begin.size() + 1);
}

#define EXPECT_SAYS(text, part) \
  EXPECT_PRED2([](const std::string &a, const std::string &b) { return a.find(b) != a.npos; }, text, std::string(part))

TEST(MeshError, OptionsOfTheBox) {
  EXPECT_SAYS(ErrorOf(""), "give -mesh FILE.msh");
  EXPECT_SAYS(ErrorOf("-mesh box"), "needs -mesh_box_cells");
  EXPECT_SAYS(ErrorOf("-mesh box -mesh_box_cells 2,0,2 -mesh_box_size 1,1,1"), "0 cells along y");
  EXPECT_SAYS(ErrorOf("-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 1,1,-1"), "m along z; it must be > 0");
  EXPECT_SAYS(ErrorOf("-mesh box -mesh_box_cells 2000,2000,2000 -mesh_box_size 1,1,1"), "too many");
  EXPECT_SAYS(ErrorOf("-mesh box -mesh_box_cells 2,2,2 -mesh_box_size 1,1,1 -mesh_box_jitter 0.6"), "below 0.5");
  EXPECT_SAYS(ErrorOf("-mesh box -mesh_box_cells 6,6,6 -mesh_box_size 1,1,1 -mesh_box_shape tet -mesh_box_jitter 0.49"),
              "lower -mesh_box_jitter");
}

TEST(MeshError, FilesThatAreNone) {
  EXPECT_SAYS(ErrorOf("-mesh /no/such/file.msh"), "cannot be opened (No such file or directory)");
  EXPECT_SAYS(ErrorOf("-mesh /"), "cannot be opened (Is a directory)");
  EXPECT_SAYS(ErrorOfFile(""), "is empty");
  EXPECT_SAYS(ErrorOfFile("solid cube\n"), "does not begin with $MeshFormat");
  EXPECT_SAYS(ErrorOfFile("$MeshFormat\n4 0 8\n$EndMeshFormat\n"), "save it as 4.1 or 2.2");
  EXPECT_SAYS(ErrorOfFile("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), "has no $Elements");
}

TEST(MeshError, ElementsThatArePossibleElsewhere) {
  const std::vector<std::string> nodes{"0 0 0", "1 0 0", "1 1 0", "0 1 0", ".5 .5 1",
                                       "0 0 1", "1 0 1", "1 1 1", "0 1 1", "2 2 2"};
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(nodes).Elements({"7 2 1 1 1 2 3 4 5"}).Text()), "pyramids");
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(nodes).Elements({"11 2 1 1 1 2 3 4 5 6 7 8 9 10"}).Text()),
              "Mesh.ElementOrder = 1");
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(nodes).Elements({"2 2 1 1 1 2 3"}).Text()), "no volume elements");
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(nodes).Elements({"99 2 1 1 1 2 3"}).Text()), "gmsh type 99");
}

TEST(MeshError, Nodes) {
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes({"0 0 0", "1 0 0", "0 nan 0", "0 0 1", "0 0 -1"}).Text()),
              "node 3 has a coordinate y");
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes({"0 0 0", "1 0 0", "0 1 0", "0 0 1"}).Text()),
              "element 20 uses node 5, which is not there");
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 1"}).Text()),
              "element 20 uses node 1 twice");
}

TEST(MeshError, CellsAndFaces) {
  EXPECT_SAYS(
      ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 2 3 5"}).Text()),
      "1 of 2 elements are inverted or degenerate (det J <= 0 at a corner or integration point), the first is tet4 20 "
      "with its centroid at (0.25, 0.25, -0.25)");
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes({"0 0 0", "1 0 0", "0 1 0", "1 1 1e-14", "0 0 -1"}).Text()),
              "the first is tet4 10");
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 5", "4 2 2 2 1 3 2 5"}).Text()),
              "elements are there twice: element 20 and element 30");
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 2 2 1 2 3 4"}).Text()),
              "elements are there twice: element 10 and element 20");
  EXPECT_SAYS(ErrorOfFile(Msh()
                              .Nodes({"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1", ".1 .1 2"})
                              .Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 5", "4 2 1 1 1 2 3 6"})
                              .Text()),
              "more than two elements meet at a face (1 times): element 10, element 20 and element 30");
}

TEST(MeshError, GroupsAndNames) {
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 0 1 1 3 2 5"}).Text()),
              "1 of 2 volume elements are in no");
  EXPECT_SAYS(
      ErrorOfFile(Msh().Names("3 1 \"a b\"\n3 2 \"A:b\"\n").Elements({"4 2 1 1 1 2 3 4", "4 2 2 1 1 3 2 5"}).Text()),
      "the physical volume 1 and the volume 2 are both called 'A_b'");
  EXPECT_SAYS(ErrorOfFile(Msh()
                              .Names("1 1 \"top\"\n2 2 \"top\"\n")
                              .Elements({"4 2 1 1 1 2 3 4", "2 2 2 1 1 2 3", "1 2 1 1 1 2"})
                              .Text()),
              "both called 'top'");
  EXPECT_EQ(
      ErrorOfFile(Msh().Names("3 1 \"top\"\n2 2 \"top\"\n").Elements({"4 2 1 1 1 2 3 4", "2 2 2 1 1 2 3"}).Text()), "");
}

TEST(MeshError, SurfacesThatAreNotOfTheMesh) {
  const std::vector<std::string> nodes{"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1", "5 5 5"};
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(nodes).Elements({"4 2 1 1 1 2 3 4", "2 2 2 1 1 2 6"}).Text()),
              "surface element 20 hangs on node 6");
  EXPECT_NE(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 5", "2 2 2 1 1 4 5"}).Text()), "");
  EXPECT_NE(ErrorOfFile(Msh().Elements({"4 2 1 1 1 2 3 4", "4 2 1 1 1 3 2 5", "3 2 2 1 1 2 3 4"}).Text()), "");
}

// A triangle over half a quadrilateral is no face: PETSc's reader would label the whole face.
TEST(MeshError, HalfAFaceAsASurface) {
  const std::vector<std::string> cube{"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"};
  const std::string hex = "5 2 1 1 1 2 3 4 5 6 7 8";
  EXPECT_SAYS(ErrorOfFile(Msh().Nodes(cube).Elements({hex, "2 2 2 1 1 2 3"}).Text()),
              "elements of surface 'surface_2'");
  EXPECT_EQ(ErrorOfFile(Msh().Nodes(cube).Elements({hex, "3 2 2 1 1 2 3 4", "3 2 2 1 4 3 2 1"}).Text()), "");
}

TEST(MeshError, TagsThatLabelsCannotHold) {
  const std::string tet = "4 2 1 1 1 2 3 4";
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({"4 2 -1 1 1 2 3 4", "4 2 -1 1 1 3 2 5"}).Text()), "the physical group -1");
  EXPECT_SAYS(ErrorOfFile(Msh().Elements({tet, "2 2 -1 1 1 2 3"}).Text()), "element 20 is in the physical group -1");
  EXPECT_EQ(ErrorOfFile(Msh().Elements({tet, "2 2 -2 1 1 2 3"}).Text()), "");
}

TEST(MeshError, Numbers) {
  const auto spoilt = [](std::string text, const std::string &old, const std::string &by) {
    return ErrorOfFile(text.replace(text.find(old), old.size(), by));
  };
  const std::string text = Msh().Names("3 1 \"rock\"\n").Text();
  EXPECT_EQ(ErrorOfFile(text), "");
  EXPECT_SAYS(spoilt(text, "2.2 0 8", "2.24 0 8"), "save it as 4.1 or 2.2");
  EXPECT_SAYS(spoilt(text, "2.2 0 8", "2.2 2 8"), "broken header");
  EXPECT_SAYS(spoilt(text, "2.2 0 8", "2.2 0 8 1"), "broken header");
  EXPECT_SAYS(spoilt(text, "3 1 \"rock\"", "3 1e0 \"rock\""), "a line in $PhysicalNames");
  EXPECT_SAYS(spoilt(text, "$Nodes\n5", "$Nodes\n5 6"), "'6' behind the number");
  EXPECT_SAYS(spoilt(text, "$Nodes\n5", "$Nodes\n9223372036854775808"), "a number is expected");
  EXPECT_SAYS(spoilt(text, "10 4 2 1 1 1 2 3 4", "10 4 2 4294967297 1 1 2 3 4"),
              "beyond 32 bits in $Elements: 4294967297");
  EXPECT_SAYS(spoilt(text, "10 4 2 1 1 1 2 3 4", "10 4 2 1.5 1 1 2 3 4"), "a number is expected");
  EXPECT_SAYS(spoilt(text, "$Nodes", "$Periodic\n0\n$EndPeriodic\n$Nodes"), "the section $Periodic where it cannot be");
  EXPECT_EQ(spoilt(text, "$Nodes", "$Comments\n$Nodes 7\n$EndComments\n$Nodes"), "");
}

TEST(MeshError, NumbersOfFormat41) {
  std::ifstream in(MeshFolder() + "/mixed_41a.msh");
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto spoilt = [&](const std::string &old, const std::string &by) {
    std::string text = whole;
    return ErrorOfFile(text.replace(text.find(old), old.size(), by));
  };
  EXPECT_SAYS(spoilt("13 24 15 3", "13 -24 15 3"), "is truncated");
  EXPECT_SAYS(spoilt("13 24 15 3", "999999999999 24 15 3"), "is truncated");
  EXPECT_SAYS(spoilt("\n2 1 0 0 0 \n", "\n1 1 0 0 0 \n"), "describes the point 1 twice");
  const std::size_t nodes = whole.find("$Nodes\n") + 7, elements = whole.find("$Elements\n") + 10;
  const auto head = [&](std::size_t at) { return whole.substr(at, whole.find('\n', at) - at); };
  const auto more = [](const std::string &line) {  // one more in all
    std::istringstream words(line);
    std::int64_t n[4];
    for (std::int64_t &k : n) words >> k;
    return std::to_string(n[0]) + " " + std::to_string(n[1] + 1) + " " + std::to_string(n[2]) + " " +
           std::to_string(n[3]);
  };
  EXPECT_SAYS(spoilt("$Nodes\n" + head(nodes), "$Nodes\n" + more(head(nodes))), "$Nodes announces");
  EXPECT_SAYS(spoilt("$Elements\n" + head(elements), "$Elements\n" + more(head(elements))), "$Elements announces");
}

TEST(MeshFile, NamesAndRemarksWithoutGroups) {
  const TemporaryFile file(
      Msh()
          .Nodes({"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1", "5 5 5", "0 0 0"})
          .Names("3 9 \"lost\"\n")
          .Elements({"4 2 0 1 1 2 3 4", "4 2 0 1 7 3 2 5", "2 2 4 1 1 2 3", "15 2 8 1 6", "1 2 3 1 1 2"})
          .Text());
  Mesh mesh;
  ASSERT_EQ(Make(PETSC_COMM_SELF, "-mesh " + file.path(), &mesh), PETSC_SUCCESS);
  EXPECT_EQ(mesh.regions, std::vector<std::string>{"mesh"});
  EXPECT_EQ(mesh.surfaces, std::vector<std::string>{"surface_4"});
  EXPECT_EQ(mesh.point_sets, (std::vector<std::string>{"line_3", "point_8"}));
  EXPECT_EQ(mesh.set_vertices[0].size(), 2u);
  EXPECT_EQ(mesh.set_vertices[1].size(), 0u);
  EXPECT_EQ(mesh.vertex_x.size(), 18u);
  ASSERT_EQ(mesh.remarks.size(), 3u);
  EXPECT_SAYS(mesh.remarks[0], "1 nodes belong to no volume element");
  EXPECT_SAYS(mesh.remarks[1], "physical volume 'lost' has no elements");
  EXPECT_SAYS(mesh.remarks[2], "1 nodes lie on other nodes");
}

// Every cut is an error, and nothing that is written over a file crashes the scan.
TEST(MeshFile, BrokenFiles) {
  for (const char *name : {"41a", "41b", "22a", "22b"}) {
    std::ifstream in(MeshFolder() + "/mixed_" + name + ".msh", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::size_t end = bytes.find("$EndElements") + 12;
    ASSERT_LT(end, bytes.size() + 1);
    for (std::size_t cut = 0; cut < end; cut += cut + 200 < end ? 61 : 1) {
      const TemporaryFile file(bytes.substr(0, cut));
      EXPECT_THROW(ScanGmsh(file.path()), GmshError) << name << " cut at " << cut;
    }
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
      std::string broken = bytes;
      for (int k = 0; k < 3; ++k) broken[random() % broken.size()] = static_cast<char>(random());
      const TemporaryFile file(broken);
      try {
        ScanGmsh(file.path());
      } catch (const GmshError &) {}
    }
  }
}

}  // namespace
}  // namespace cdem
