#include "io/vtk_series.hpp"

#include "core/error.hpp"
#include "io/blocks.hpp"
#include "io/hdf5_file.hpp"
#include "io/safe_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cdem {

namespace {

const char *const kMeshSets[] = {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points", "Connectivity",
                                 "Offsets",        "Types"};

// The attributes by which VTK knows the file.
void Describe(Hdf5File *file) {
  file->Integers("Version", {1, 0});
  file->Word("Type", "UnstructuredGrid");
}

}  // namespace

VtkSeries::~VtkSeries() {
  PetscBool finalized = PETSC_FALSE;
  (void)PetscFinalized(&finalized);
  if (finalized) return;
  (void)PetscSFDestroy(&point_sf_);
  (void)PetscSFDestroy(&cell_sf_);
}

PetscErrorCode VtkSeries::Create(MPI_Comm comm, const std::string &dir, const std::string &name, const VtkMesh &mesh,
                                 int number) {
  PetscFunctionBeginUser;
  comm_ = comm;
  dir_ = dir;
  name_ = name;
  char tail[20];
  std::snprintf(tail, sizeof tail, "_mesh_%03d.h5", number);
  mesh_name_ = name + tail;
  PetscCall(PetscSFDestroy(&point_sf_));
  PetscCall(PetscSFDestroy(&cell_sf_));
  Hdf5Block points, cells;
  PetscCall(CreateBlocks(comm, mesh.point_global, "points", &point_sf_, &points));
  PetscCall(CreateBlocks(comm, mesh.cell_global, "cells", &cell_sf_, &cells));
  n_points_ = static_cast<PetscInt>(mesh.point_global.size());
  n_cells_ = static_cast<PetscInt>(mesh.cell_global.size());
  points_total_ = static_cast<std::int64_t>(points.total);
  cells_total_ = static_cast<std::int64_t>(cells.total);
  point_offset_ = static_cast<std::int64_t>(points.offset);
  cell_offset_ = static_cast<std::int64_t>(cells.offset);
  point_rows_ = static_cast<PetscInt>(points.rows);
  cell_rows_ = static_cast<PetscInt>(cells.rows);

  std::vector<double> coordinates(3 * points.rows);
  PetscCall(ToBlock(point_sf_, MPI_DOUBLE, 3, mesh.points.data(), &coordinates));

  // Cells travel with a fixed width: type, number of points, points.
  int most = 0, width;
  for (std::size_t c = 0; c < mesh.cell_global.size(); ++c)
    most = std::max(most, mesh.cell_start[c + 1] - mesh.cell_start[c]);
  PetscCallMPI(MPI_Allreduce(&most, &width, 1, MPI_INT, MPI_MAX, comm));
  width += 2;
  std::vector<std::int64_t> rows(mesh.cell_global.size() * static_cast<std::size_t>(width));
  for (std::size_t c = 0; c < mesh.cell_global.size(); ++c) {
    std::int64_t *row = &rows[c * static_cast<std::size_t>(width)];
    row[0] = mesh.cell_type[c];
    row[1] = mesh.cell_start[c + 1] - mesh.cell_start[c];
    std::copy(mesh.cell_points.data() + mesh.cell_start[c], mesh.cell_points.data() + mesh.cell_start[c + 1], row + 2);
  }
  std::vector<std::int64_t> block(cells.rows * static_cast<std::size_t>(width));
  PetscCall(ToBlock(cell_sf_, MPI_INT64_T, width, rows.data(), &block));
  std::vector<std::int64_t>().swap(rows);

  std::vector<std::uint8_t> types(cells.rows);
  std::vector<std::int64_t> ends(cells.rows), connectivity;
  std::int64_t outside = 0;
  for (std::size_t c = 0; c < cells.rows; ++c) {
    const std::int64_t *row = &block[c * static_cast<std::size_t>(width)];
    types[c] = static_cast<std::uint8_t>(row[0]);
    connectivity.insert(connectivity.end(), row + 2, row + 2 + row[1]);
    ends[c] = static_cast<std::int64_t>(connectivity.size());
  }
  for (const std::int64_t p : connectivity) outside += p < 0 || p >= points_total_;
  const std::int64_t mine[2] = {static_cast<std::int64_t>(connectivity.size()), outside};
  std::int64_t before[2] = {0, 0}, total[2];
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Exscan(mine, before, 2, MPI_INT64_T, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(mine, total, 2, MPI_INT64_T, MPI_SUM, comm));
  PetscCheck(total[1] == 0, comm, PETSC_ERR_PLIB, "cells of a mesh for output name points that it does not have");
  if (rank == 0) before[0] = 0;  // Exscan leaves it undefined
  for (std::int64_t &end : ends) end += before[0];
  Hdf5Block ids = {static_cast<hsize_t>(total[0]), static_cast<hsize_t>(before[0]), connectivity.size()};
  Hdf5Block offsets = {cells.total + 1, cells.offset + 1, cells.rows};
  if (rank == 0) {  // the leading 0 of the offsets
    ends.insert(ends.begin(), 0);
    offsets.offset = 0;
    ++offsets.rows;
  }

  Hdf5File file(comm, dir_ + "/" + mesh_name_ + ".part");
  PetscCall(file.Open("VTKHDF", 24 * points_total_ + 8 * total[0] + 9 * cells_total_));
  Describe(&file);
  const Hdf5Block one = {1, 0, rank == 0 ? 1u : 0u};
  const hid_t top = file.top(), i64 = H5T_STD_I64LE, n64 = H5T_NATIVE_INT64;
  PetscCall(file.Write(top, "NumberOfPoints", i64, n64, one, 0, &points_total_));
  PetscCall(file.Write(top, "NumberOfCells", i64, n64, one, 0, &cells_total_));
  PetscCall(file.Write(top, "NumberOfConnectivityIds", i64, n64, one, 0, &total[0]));
  PetscCall(file.Write(top, "Points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, points, 3, coordinates.data()));
  PetscCall(file.Write(top, "Connectivity", i64, n64, ids, 0, connectivity.data()));
  PetscCall(file.Write(top, "Offsets", i64, n64, offsets, 0, ends.data()));
  PetscCall(file.Write(top, "Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, cells, 0, types.data()));
  PetscCall(file.Finish(dir_ + "/" + mesh_name_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VtkSeries::WriteFrame(PetscInt step, double time, const std::vector<VtkField> &fields) {
  PetscFunctionBeginUser;
  PetscCheck(point_sf_, PETSC_COMM_SELF, PETSC_ERR_ORDER, "a frame before its mesh");
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm_, &rank));
  if (!frames_.empty() && frames_.back().step == step) PetscFunctionReturn(PETSC_SUCCESS);
  const long long count = frames_.empty() ? 0 : frames_.back().number + 1;
  const std::string frame = FileName(count);

  std::int64_t numbers = 0;
  for (const VtkField &field : fields) numbers += field.components * (field.on_points ? points_total_ : cells_total_);
  Hdf5File file(comm_, dir_ + "/" + frame + ".part");
  PetscCall(file.Open("VTKHDF", 8 * numbers));
  Describe(&file);
  for (const char *name : kMeshSets) file.Link(name, mesh_name_, std::string("/VTKHDF/") + name);
  const Hdf5Block one = {1, 0, rank == 0 ? 1u : 0u};
  const std::int64_t steps = step;
  const hid_t own = file.Group("FieldData");
  PetscCall(file.Write(own, "Step", H5T_STD_I64LE, H5T_NATIVE_INT64, one, 0, &steps));
  PetscCall(file.Write(own, "Time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, one, 0, &time));
  const hid_t on_points = file.Group("PointData"), on_cells = file.Group("CellData");
  const Hdf5Block points = {static_cast<hsize_t>(points_total_), static_cast<hsize_t>(point_offset_),
                            static_cast<hsize_t>(point_rows_)};
  const Hdf5Block cells = {static_cast<hsize_t>(cells_total_), static_cast<hsize_t>(cell_offset_),
                           static_cast<hsize_t>(cell_rows_)};
  std::vector<double> values;
  for (const VtkField &field : fields) {
    const Hdf5Block &block = field.on_points ? points : cells;
    values.resize(block.rows * static_cast<std::size_t>(field.components));
    PetscCall(ToBlock(field.on_points ? point_sf_ : cell_sf_, MPI_DOUBLE, field.components, field.data, &values));
    PetscCall(file.Write(field.on_points ? on_points : on_cells, field.name.c_str(), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                         block, field.components > 1 ? field.components : 0, values.data()));
  }
  PetscCall(file.Finish(dir_ + "/" + frame));

  frames_.push_back({count, step, time});
  PetscCall(WriteList());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VtkSeries::Continue(const std::vector<KeptFrame> &frames) {
  PetscFunctionBeginUser;
  frames_ = frames;
  listed_ = 0;
  list_.clear();
  PetscCall(WriteList());
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string VtkSeries::FileName(long long number) const {
  char text[40];
  std::snprintf(text, sizeof(text), "_%06lld.hdf", number);
  return name_ + text;
}

PetscErrorCode VtkSeries::WriteList() {
  PetscFunctionBeginUser;
  int rank;
  PetscCallMPI(MPI_Comm_rank(comm_, &rank));
  std::string failure;
  if (rank == 0) {
    for (; listed_ < frames_.size();
         ++listed_) {  // what is there already is not made again: runs have thousands of frames
      const KeptFrame &frame = frames_[listed_];
      list_ += (list_.empty() ? "" : ",") +
               ("\n" + nlohmann::ordered_json{{"name", FileName(frame.number)}, {"time", frame.time}}.dump());
    }
    failure = ReplaceFile(dir_ + "/" + name_ + ".hdf.series",
                          "{\"file-series-version\": \"1.0\", \"files\": [" + list_ + "\n]}\n");
  }
  PetscCall(CheckFailure(comm_, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
