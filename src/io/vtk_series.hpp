// A time series for ParaView: one VTKHDF file a frame (NAME_000000.hdf), the mesh once in NAME_mesh_000.h5 linked from
// every frame (NAME_mesh_001.h5, ... once elements have left), and NAME.hdf.series. A frame counts as written when it was renamed from .part; the series follows.
#pragma once
#include "io/earlier_run.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

/// What one rank gives of an unstructured mesh. Global numbers run from 0 without gaps over all ranks, and the file is in
/// their order: it does not depend on the ranks.
struct VtkMesh {
  std::vector<std::int64_t> point_global;  ///< [n_points] global number of each point this rank gives
  std::vector<double> points;              ///< [n_points][3] m
  std::vector<std::int64_t> cell_global;   ///< [n_cells] global number of each cell this rank gives
  std::vector<std::uint8_t> cell_type;     ///< [n_cells] VTK type
  std::vector<int> cell_start;             ///< [n_cells + 1] into cell_points
  std::vector<std::int64_t> cell_points;   ///< global point numbers
};

/// One row of a frame: host data of the points or cells this rank gave, in its order.
struct VtkField {
  std::string name;
  bool on_points;
  int components;
  const double *data;
};

class VtkSeries {
 public:
  ~VtkSeries();
  /// Writes the mesh file in folder dir (which exists); frames from now on are of this mesh. Collective. [in] number: of
  /// the mesh among those of the series.
  PetscErrorCode Create(MPI_Comm comm, const std::string &dir, const std::string &name, const VtkMesh &mesh,
                        int number = 0);
  /// Goes on behind frames that an earlier run has left in the folder: the series names them alone now. Collective.
  PetscErrorCode Continue(const std::vector<KeptFrame> &frames);
  /// Writes one frame and then the series file, each safely (temporary file, rename). Collective. The file of a frame is
  /// numbered by frames, from 0. A frame of a step that is there already stays.
  PetscErrorCode WriteFrame(PetscInt step, double time, const std::vector<VtkField> &fields);

 private:
  std::string FileName(long long number) const;
  PetscErrorCode WriteList();

  MPI_Comm comm_ = MPI_COMM_NULL;
  std::string dir_, name_, mesh_name_;
  PetscSF point_sf_ = nullptr, cell_sf_ = nullptr;  // from this rank's rows to contiguous blocks of the file
  PetscInt n_points_ = 0, n_cells_ = 0;             // of this rank
  std::int64_t point_offset_ = 0, cell_offset_ = 0, points_total_ = 0, cells_total_ = 0;
  PetscInt point_rows_ = 0, cell_rows_ = 0;  // of this rank's block of the file
  std::vector<KeptFrame> frames_;
  std::string list_;  // the series file's words for the first listed_ of them
  std::size_t listed_ = 0;
};

}  // namespace cdem
