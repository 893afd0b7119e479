// The folder of a run and the frames for ParaView. Passes on any number of ranks.
#include "core/error.hpp"
#include "io/output_dir.hpp"
#include "io/safe_file.hpp"
#include "io/vtk_series.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <map>
#include <numeric>
#include <sstream>

namespace fs = std::filesystem;
using namespace cdem;

namespace {

int Rank(MPI_Comm comm = PETSC_COMM_WORLD) {
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}
int Size(MPI_Comm comm = PETSC_COMM_WORLD) {
  int size;
  MPI_Comm_size(comm, &size);
  return size;
}

std::string Read(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void Touch(const std::string &path) { std::ofstream(path) << "x"; }

std::string message;  // of the last error
PetscErrorCode KeepMessage(MPI_Comm, int, const char *, const char *, PetscErrorCode code, PetscErrorType type,
                           const char *text, void *) {
  if (type == PETSC_ERROR_INITIAL) message = text;
  return code;
}

// A folder that all ranks share and rank 0 removes.
class Io : public ::testing::Test {
 protected:
  void SetUp() override {
    char name[64] = "/tmp/cdem_io_XXXXXX";
    if (Rank() == 0 && !mkdtemp(name)) GTEST_FAIL() << name;
    MPI_Bcast(name, sizeof(name), MPI_CHAR, 0, PETSC_COMM_WORLD);
    dir_ = name;
    message.clear();
    PetscCallAbort(PETSC_COMM_WORLD, PetscPushErrorHandler(KeepMessage, nullptr));
  }
  void TearDown() override {
    PetscCallAbort(PETSC_COMM_WORLD, PetscPopErrorHandler());
    MPI_Barrier(PETSC_COMM_WORLD);
    if (Rank() == 0) fs::remove_all(dir_);
    MPI_Barrier(PETSC_COMM_WORLD);
  }
  void Barrier() { MPI_Barrier(PETSC_COMM_WORLD); }
  std::string dir_;
};

#define EXPECT_OK(call) EXPECT_EQ(call, PETSC_SUCCESS) << message
#define EXPECT_REFUSED(call, part)                                                                          \
  do {                                                                                                      \
    EXPECT_EQ(call, PETSC_ERR_USER_INPUT);                                                                  \
    EXPECT_NE(message.find(part), std::string::npos) << "\"" << message << "\" lacks \"" << (part) << "\""; \
  } while (0)

// ---------------------------------------------------------------------------------------------------- files and folder

TEST_F(Io, WritesFilesSafely) {
  const std::string path = dir_ + "/a_" + std::to_string(Rank());
  EXPECT_OK(WriteFileSafely(path, "one"));
  EXPECT_OK(WriteFileSafely(path, "two\n"));
  EXPECT_EQ(Read(path), "two\n");
  EXPECT_FALSE(fs::exists(path + ".part"));
  EXPECT_REFUSED(WriteFileSafely(dir_ + "/none/a", "x"), "No such file");
  fs::create_directory(path + "_dir");
  EXPECT_REFUSED(WriteFileSafely(path + "_dir", "x"), "Is a directory");
  EXPECT_FALSE(fs::exists(path + "_dir.part"));
}

TEST_F(Io, TellsAllRanksOfTheFailureOfOne) {
  EXPECT_OK(CheckFailure(PETSC_COMM_WORLD, ""));
  const int last = Size() - 1;
  EXPECT_REFUSED(CheckFailure(PETSC_COMM_WORLD, Rank() == last ? "here " + std::to_string(last) : ""),
                 "here " + std::to_string(last));
}

TEST_F(Io, MakesTheFolder) {
  EXPECT_OK(PrepareOutputDir(PETSC_COMM_WORLD, dir_ + "/a/b c", false));
  EXPECT_TRUE(fs::exists(dir_ + "/a/b c/scene.opts"));
  EXPECT_OK(PrepareOutputDir(PETSC_COMM_WORLD, dir_ + "/a/b c/", false));  // nothing in it but scene.opts
  Barrier();
  if (Rank() == 0) Touch(dir_ + "/file");
  EXPECT_REFUSED(PrepareOutputDir(PETSC_COMM_WORLD, dir_ + "/file", false), dir_ + "/file");
  EXPECT_REFUSED(PrepareOutputDir(PETSC_COMM_WORLD, dir_ + "/file/below", false), "cannot make the output folder");
  EXPECT_REFUSED(PrepareOutputDir(PETSC_COMM_WORLD, "", false), "-output");
  EXPECT_REFUSED(PrepareOutputDir(PETSC_COMM_WORLD, "/proc/cdem", true), "/proc/cdem");
}

TEST_F(Io, RefusesAFolderWithResultsAndOverwritesOnlyThem) {
  const std::vector<std::string> results = {"summary.json",           "histories.csv",         "fields_000000.hdf",
                                            "fields.hdf.series",      "fields_mesh_000.h5",    "checkpoint_12000.h5",
                                            "interfaces_1234567.hdf", "interfaces_mesh_003.h5"};
  for (const std::string &name : results) {
    Barrier();
    if (Rank() == 0) Touch(dir_ + "/" + name);
    EXPECT_REFUSED(PrepareOutputDir(PETSC_COMM_WORLD, dir_, false), dir_);
    EXPECT_NE(message.find("-output_overwrite"), std::string::npos);
    EXPECT_NE(message.find(name), std::string::npos);
    EXPECT_FALSE(fs::exists(dir_ + "/scene.opts"));
    Barrier();
    if (Rank() == 0) fs::remove(dir_ + "/" + name);
  }
  const std::vector<std::string> leftovers = {"fields_000007.hdf.part", "summary.json.part", "fields_mesh_000.h5.part"};
  const std::vector<std::string> others = {"scene.yaml",        "terrain.hdf",    "rock_mesh_fine.h5",
                                           "rock.msh",          "histories.csv~", "my_summary.json",
                                           "checkpoint_old.h5", "film.mp4.part",  "checkpoint_1.txt",
                                           "my_histories.csv",  ".hdf",           "a_.hdf"};
  Barrier();
  if (Rank() == 0) {
    for (const auto *list : {&results, &leftovers, &others})
      for (const std::string &name : *list) Touch(dir_ + "/" + name);
    fs::create_directory(dir_ + "/old_000000.hdf");  // a folder
    Touch(dir_ + "/old_000000.hdf/summary.json");
  }
  EXPECT_OK(PrepareOutputDir(PETSC_COMM_WORLD, dir_, true));
  for (const auto *list : {&results, &leftovers})
    for (const std::string &name : *list) EXPECT_FALSE(fs::exists(dir_ + "/" + name)) << name;
  for (const std::string &name : others) EXPECT_TRUE(fs::exists(dir_ + "/" + name)) << name;
  EXPECT_TRUE(fs::exists(dir_ + "/old_000000.hdf/summary.json"));
  EXPECT_OK(PrepareOutputDir(PETSC_COMM_WORLD, dir_, false));
}

// All options as PETSc has them; what differs is in values, so each is read one by one.
TEST_F(Io, SceneOptsReadsBack) {
  std::map<std::string, std::string> given = {{"t_plain", "box"},
                                              {"t_vector", "0,0,-9.81"},
                                              {"t_negative", "-5"},
                                              {"t_negative_real", "-.5e-3"},
                                              {"t_spaces", "a folder with  two spaces"},
                                              {"t_dash", "one - two -3"},
                                              {"t_like_option", "one -t_plain two"},
                                              {"t_like_pair", "x -t_zz y -t_vector 1"},
                                              {"t_empty", ""},
                                              {"t_quote", "it's"},
                                              {"t_viewer", "ascii:out file.txt:ascii_info"},
                                              {"t_backslash", "a\\b"},
                                              {"t_zz", "y"}};
  PetscOptions options, back;
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsCreate(&options));
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsPush(options));
  for (const auto &[name, value] : given) EXPECT_OK(PetscOptionsSetValue(nullptr, ("-" + name).c_str(), value.c_str()));
  for (const char *name : {"-t_flag", "-t_flag2", "-malloc_dump", "-options_left"})
    EXPECT_OK(PetscOptionsSetValue(nullptr, name, nullptr));
  EXPECT_OK(PetscOptionsSetValue(nullptr, "-nox_warning", "a -5 b"));  // PETSc never counts it as left
  EXPECT_OK(PetscOptionsSetValue(nullptr, "-options_file", "scene.yaml"));
  for (const char *bad : {"\"", "#", "\n"}) {
    const std::string name = "-t_bad_" + std::to_string(static_cast<int>(bad[0]));
    EXPECT_OK(PetscOptionsSetValue(nullptr, name.c_str(), (std::string("a") + bad + "b").c_str()));
  }
  EXPECT_OK(PetscOptionsSetValue(nullptr, "-t_bad_key", "-t_plain"));
  PetscBool set;
  for (const char *name : {"-t_spaces", "-t_like_pair", "-t_flag2", "-t_vector"})  // some are read before, some are not
    EXPECT_OK(PetscOptionsHasName(nullptr, nullptr, name, &set));
  PetscInt unread = 0, still = 0;
  EXPECT_OK(PetscOptionsAllUsed(nullptr, &unread));
  EXPECT_OK(PrepareOutputDir(PETSC_COMM_WORLD, dir_, false));
  EXPECT_OK(PetscOptionsAllUsed(nullptr, &still));
  EXPECT_EQ(unread, still) << "looking must not count as reading";
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsPop());
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsDestroy(&options));

  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsCreate(&back));
  EXPECT_OK(PetscOptionsInsertFile(PETSC_COMM_WORLD, back, (dir_ + "/scene.opts").c_str(), PETSC_TRUE));
  given["nox_warning"] = "a -5 b";
  for (const auto &[name, value] : given) {
    char text[200] = "not there";
    EXPECT_OK(PetscOptionsGetString(back, nullptr, ("-" + name).c_str(), text, sizeof(text), &set));
    EXPECT_TRUE(set) << name;
    EXPECT_EQ(text, value) << name;
  }
  for (const char *name : {"-t_flag", "-t_flag2", "-malloc_dump", "-options_left"}) {
    const char *value = "";
    EXPECT_OK(PetscOptionsFindPair(back, nullptr, name, &value, &set));
    EXPECT_TRUE(set) << name;
    EXPECT_EQ(value, nullptr) << name;
  }
  for (const char *name : {"-options_file", "-t_bad_10", "-t_bad_34", "-t_bad_35", "-t_bad_key"}) {
    EXPECT_OK(PetscOptionsHasName(back, nullptr, name, &set));
    EXPECT_FALSE(set) << name;
  }
  EXPECT_NE(Read(dir_ + "/scene.opts").find("-t_bad_35 a#b"), std::string::npos) << "a comment tells of it";
  char *all = nullptr;
  EXPECT_OK(PetscOptionsGetAll(back, &all));
  EXPECT_EQ(std::string(all).find("-t_bad"), std::string::npos);
  PetscCallAbort(PETSC_COMM_WORLD, PetscFree(all));
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsDestroy(&back));
}

TEST_F(Io, Histories) {
  const bool first = Rank() == 0;
  HistoryFile file;
  EXPECT_OK(file.Open(PETSC_COMM_WORLD, dir_, {"tip", "top"}));
  const std::string header = "step,time,tip,top\n";
  EXPECT_EQ(Read(dir_ + "/histories.csv"), header);
  Barrier();
  using Rows = std::vector<std::vector<double>>;
  EXPECT_OK(file.Append(first ? std::vector<PetscInt>{0, 1} : std::vector<PetscInt>{},
                        first ? std::vector<double>{0, 0.1} : std::vector<double>{},
                        first ? Rows{{0, -1}, {1e-300, 1.0 / 3}} : Rows{}));
  EXPECT_OK(file.Append({}, {}, {}));
  const std::string text = Read(dir_ + "/histories.csv");  // flushed: a reader sees it while the run goes on
  EXPECT_EQ(text.substr(0, header.size() + 9), header + "0,0,0,-1\n");
  double step, time, tip, top;
  ASSERT_EQ(std::sscanf(text.c_str() + header.size() + 9, "%lf,%lf,%lf,%lf", &step, &time, &tip, &top), 4);
  EXPECT_TRUE(step == 1 && time == 0.1 && tip == 1e-300 && top == 1.0 / 3);

  Barrier();
  if (first) {
    fs::create_directory(dir_ + "/full");
    fs::create_symlink("/dev/full", dir_ + "/full/histories.csv");
  }
  Barrier();
  HistoryFile full;
  EXPECT_REFUSED(full.Open(PETSC_COMM_WORLD, dir_ + "/full", {"tip"}), "No space left");
  HistoryFile none;
  EXPECT_REFUSED(none.Open(PETSC_COMM_WORLD, dir_ + "/none", {"tip"}), "No such file");
}

TEST_F(Io, Summary) {
  EXPECT_OK(WriteSummary(PETSC_COMM_WORLD, dir_, {{"dt", 0.1}, {"name", "M\xfcll"}}));  // not UTF-8
  EXPECT_EQ(nlohmann::json::parse(Read(dir_ + "/summary.json"))["dt"], 0.1);
  EXPECT_REFUSED(WriteSummary(PETSC_COMM_WORLD, dir_ + "/none", {}), "summary.json");
}

// -------------------------------------------------------------------------------------------------------------- frames

// n tetrahedra, a wedge and a quadrilateral over 4 n + 10 points, dealt out to the ranks of comm backwards.
VtkMesh ScatteredMesh(MPI_Comm comm, int n) {
  VtkMesh mesh;
  mesh.cell_start = {0};
  const int n_points = 4 * n + 10;
  for (int p = n_points - 1; p >= 0; --p) {
    if ((p * 7 + 3) % Size(comm) != Rank(comm)) continue;
    mesh.point_global.push_back(p);
    for (const double x : {p + 0.25, p * p / 3.0, -1.0 * p}) mesh.points.push_back(x);
  }
  for (int c = n + 1; c >= 0; --c) {
    if (c / 3 % Size(comm) != Rank(comm)) continue;
    const int corners = c < n ? 4 : c == n ? 6 : 4;
    mesh.cell_global.push_back(c);
    mesh.cell_type.push_back(c < n ? 10 : c == n ? 13 : 9);
    const int base = c < n ? 4 * c : c == n ? 4 * n : 4 * n + 6;
    for (int i = 0; i < corners; ++i) mesh.cell_points.push_back(base + i);
    mesh.cell_start.push_back(static_cast<int>(mesh.cell_points.size()));
  }
  return mesh;
}

// Writes two frames with fields that are functions of the global number.
PetscErrorCode WriteSeries(MPI_Comm comm, const std::string &dir, const VtkMesh &mesh) {
  PetscFunctionBeginUser;
  std::vector<double> vector, scalar, tensor;
  for (const std::int64_t p : mesh.point_global)
    for (int i = 0; i < 3; ++i) vector.push_back(10.0 * static_cast<double>(p) + i);
  for (const std::int64_t c : mesh.cell_global) {
    scalar.push_back(static_cast<double>(c) / 7);
    for (int i = 0; i < 6; ++i) tensor.push_back(100.0 * static_cast<double>(c) + i);
  }
  VtkSeries series;
  PetscCall(series.Create(comm, dir, "fields", mesh));
  for (int frame = 0; frame < 2; ++frame)
    PetscCall(series.WriteFrame(100 * frame, 0.1 * frame,
                                {{"displacement", true, 3, vector.data()},
                                 {"region", false, 1, scalar.data()},
                                 {"stress", false, 6, tensor.data()}}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

template <class T>
std::vector<T> ReadSet(hid_t file, const char *name, hid_t memory, std::vector<hsize_t> dims) {
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
  std::vector<hsize_t> found(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  H5Sget_simple_extent_dims(space, found.data(), nullptr);
  EXPECT_EQ(found, dims) << name;
  std::vector<T> data(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), 0) << name;
  H5Sclose(space);
  H5Dclose(set);
  return data;
}

TEST_F(Io, FrameHoldsWhatWasGivenInGlobalOrder) {
  const int n = 20;
  const hsize_t np = 4 * n + 10, nc = n + 2, ids = 4 * n + 10;
  EXPECT_OK(WriteSeries(PETSC_COMM_WORLD, dir_, ScatteredMesh(PETSC_COMM_WORLD, n)));
  if (Rank() != 0) return;
  const hid_t file = H5Fopen((dir_ + "/fields_000001.hdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t d = H5T_NATIVE_DOUBLE, l = H5T_NATIVE_INT64;
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/NumberOfPoints", l, {1})[0], static_cast<std::int64_t>(np));
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/NumberOfCells", l, {1})[0], static_cast<std::int64_t>(nc));
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/NumberOfConnectivityIds", l, {1})[0], static_cast<std::int64_t>(ids));
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/FieldData/Step", l, {1})[0], 100);
  EXPECT_EQ(ReadSet<double>(file, "/VTKHDF/FieldData/Time", d, {1})[0], 0.1);
  std::vector<std::int64_t> sequence(ids), offsets(1, 0);
  std::iota(sequence.begin(), sequence.end(), 0);
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/Connectivity", l, {ids}), sequence);
  std::vector<std::uint8_t> types(nc, 10);
  types[n] = 13;
  types[n + 1] = 9;
  for (const auto type : types) offsets.push_back(offsets.back() + (type == 13 ? 6 : 4));
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/Offsets", l, {nc + 1}), offsets);
  EXPECT_EQ(ReadSet<std::uint8_t>(file, "/VTKHDF/Types", H5T_NATIVE_UINT8, {nc}), types);
  const auto points = ReadSet<double>(file, "/VTKHDF/Points", d, {np, 3});
  const auto vector = ReadSet<double>(file, "/VTKHDF/PointData/displacement", d, {np, 3});
  for (std::size_t p = 0; p < np; ++p) {
    EXPECT_EQ(points[3 * p], static_cast<double>(p) + 0.25);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(vector[3 * p + i], static_cast<double>(10 * p + i));
  }
  const auto region = ReadSet<double>(file, "/VTKHDF/CellData/region", d, {nc});
  const auto stress = ReadSet<double>(file, "/VTKHDF/CellData/stress", d, {nc, 6});
  for (std::size_t c = 0; c < nc; ++c) {
    EXPECT_EQ(region[c], static_cast<double>(c) / 7);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(stress[6 * c + i], static_cast<double>(100 * c + i));
  }
  H5L_info_t link;
  ASSERT_GE(H5Lget_info(file, "/VTKHDF/Points", &link, H5P_DEFAULT), 0);
  EXPECT_EQ(link.type, H5L_TYPE_EXTERNAL);
  H5Fclose(file);
  EXPECT_FALSE(fs::exists(dir_ + "/fields_000001.hdf.part"));
  EXPECT_LT(fs::file_size(dir_ + "/fields_000001.hdf"), 8 * (3 * np + 7 * nc) + 10000) << "the mesh is written once";
  const auto json = nlohmann::json::parse(Read(dir_ + "/fields.hdf.series"));
  EXPECT_EQ(json["file-series-version"], "1.0");
  ASSERT_EQ(json["files"].size(), 2u);
  EXPECT_EQ(json["files"][1]["name"], "fields_000001.hdf");
  EXPECT_EQ(json["files"][1]["time"].get<double>(), 0.1);
}

TEST_F(Io, FilesDoNotDependOnTheRanks) {
  for (const int n : {1, 20, 500}) {
    const std::string one = dir_ + "/one" + std::to_string(n), all = dir_ + "/all" + std::to_string(n);
    Barrier();
    if (Rank() == 0) {
      fs::create_directory(one);
      fs::create_directory(all);
      EXPECT_OK(WriteSeries(PETSC_COMM_SELF, one, ScatteredMesh(PETSC_COMM_SELF, n)));
    }
    Barrier();
    EXPECT_OK(WriteSeries(PETSC_COMM_WORLD, all, ScatteredMesh(PETSC_COMM_WORLD, n)));
    for (const char *name : {"/fields_mesh_000.h5", "/fields_000000.hdf", "/fields_000001.hdf", "/fields.hdf.series"}) {
      EXPECT_GT(Read(one + name).size(), 100u);
      EXPECT_TRUE(Read(one + name) == Read(all + name)) << name << " with " << n << " tetrahedra";
    }
  }
}

TEST_F(Io, MeshWithoutCells) {
  VtkMesh mesh;
  mesh.cell_start = {0};
  EXPECT_OK(WriteSeries(PETSC_COMM_WORLD, dir_, mesh));
  if (Rank() != 0) return;
  const hid_t file = H5Fopen((dir_ + "/fields_000000.hdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_EQ(ReadSet<std::int64_t>(file, "/VTKHDF/Offsets", H5T_NATIVE_INT64, {1}), std::vector<std::int64_t>{0});
  H5Fclose(file);
}

TEST_F(Io, ClearErrorsOfFrames) {
  const VtkMesh good = ScatteredMesh(PETSC_COMM_WORLD, 5);
  VtkSeries series;
  EXPECT_REFUSED(series.Create(PETSC_COMM_WORLD, dir_ + "/none", "fields", good), "No such file");
  EXPECT_NE(message.find(dir_ + "/none/fields_mesh_000.h5"), std::string::npos);
  EXPECT_OK(series.Create(PETSC_COMM_WORLD, dir_, "fields", good));
  const std::vector<double> data(good.point_global.size());
  EXPECT_OK(series.WriteFrame(0, 0, {{"a", true, 1, data.data()}}));
  // A refused frame leaves nothing behind and the next one takes its number.
  EXPECT_REFUSED(series.WriteFrame(1, 1, {{"a", true, 1, data.data()}, {"a", true, 1, data.data()}}),
                 "fields_000001.hdf");
  EXPECT_FALSE(Rank() == 0 && fs::exists(dir_ + "/fields_000001.hdf.part"));
  EXPECT_OK(series.WriteFrame(2, 2, {{"a", true, 1, data.data()}}));
  EXPECT_TRUE(fs::exists(dir_ + "/fields_000001.hdf"));
  Barrier();
  if (Rank() == 0) {
    fs::remove(dir_ + "/fields.hdf.series");
    fs::create_directory(dir_ + "/fields.hdf.series");
  }
  EXPECT_REFUSED(series.WriteFrame(3, 3, {{"a", true, 1, data.data()}}), "fields.hdf.series");

  VtkMesh bad = good;
  if (!bad.point_global.empty()) bad.point_global[0] = 1000000;
  EXPECT_EQ(series.Create(PETSC_COMM_WORLD, dir_, "bad", bad), PETSC_ERR_PLIB);
  bad = good;
  if (bad.cell_global.size() > 1) bad.cell_global[0] = bad.cell_global[1];
  EXPECT_EQ(series.Create(PETSC_COMM_WORLD, dir_, "bad", bad), PETSC_ERR_PLIB);
  bad = good;
  if (!bad.cell_points.empty()) bad.cell_points[0] = -1;
  EXPECT_EQ(series.Create(PETSC_COMM_WORLD, dir_, "bad", bad), PETSC_ERR_PLIB);
  VtkSeries none;
  EXPECT_EQ(none.WriteFrame(0, 0, {}), PETSC_ERR_ORDER);
}

}  // namespace
