// The part of a disc that lies inside a region of the mesh: exact, and the same to the last bit on any number of ranks.
#pragma once
#include "joints/bins.hpp"
#include "mesh/mesh.hpp"

namespace cdem {

/// Area of the part of a circle about the origin that lies inside a polygon [m^2], of either sense of rotation.
double CircleInPolygon(int corners, const double (*x)[2], double radius);

/// Area of the part of a disc that lies inside a cell of the mesh [m^2]. A disc on a face counts for the cell above it.
double DiscInCell(const Mesh &mesh, PetscInt cell, const Disc &disc);

/// The cells of a region, for clipping.
class Region {
 public:
  double lower[3], upper[3];  ///< bounding box [m]
  double volume = 0;          ///< m^3

  /// [in] region: index into mesh.regions, -1 for the whole mesh. Collective.
  PetscErrorCode Create(const Mesh &mesh, int region);
  /// Sets disc.inside of each disc (collective, the same discs on all ranks).
  PetscErrorCode Clip(std::vector<Disc> *discs) const;

 private:
  const Mesh *mesh_ = nullptr;
  std::vector<PetscInt> cell_;  // own ones
  PointBins bins_;
};

}  // namespace cdem
