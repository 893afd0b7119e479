#include "loads/quiet.hpp"

#include "core/small.hpp"
#include "forces/tables.hpp"
#include "mesh/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

int FaceDashpots(const Mesh &mesh, const Nodes &nodes, const std::vector<Material> &materials, const Face &face,
                 int side, Dashpot *dashpots) {
  const Material &m = materials[mesh.cell_region[face.cell[side]]];
  const double along = std::sqrt(m.density * (m.lambda() + 2 * m.mu())), across = std::sqrt(m.density * m.mu());
  double x[4][3];
  FacePoint points[4];
  const int size = FaceCorners(mesh, face, x), n_points = FacePoints(size, x, points);
  for (int j = 0; j < size; ++j) {
    dashpots[j].node = FaceNode(mesh, nodes, face, j, side);
    double *c = dashpots[j].c;
    std::fill_n(c, 6, 0.0);
    for (int g = 0; g < n_points; ++g) {
      const double *a = points[g].area;
      const double area = std::sqrt(Dot(a, a)), share = points[g].shape[j];
      const double extra = share * (along - across) / area;
      for (int k = 0; k < 3; ++k) c[k] += share * across * area + extra * a[k] * a[k];
      c[kXY] += extra * a[0] * a[1];
      c[kYZ] += extra * a[1] * a[2];
      c[kXZ] += extra * a[0] * a[2];
    }
  }
  return size;
}

void RemarkUnheldWeight(const std::vector<Boundary> &boundaries, const double *gravity,
                        std::vector<std::string> *remarks) {
  std::string sinks;
  for (int k = 0; k < 3; ++k) {
    const auto holds = [&](const Boundary &b) { return b.kind[k] != kFree; };
    if (gravity[k] != 0 && std::none_of(boundaries.begin(), boundaries.end(), holds))
      sinks += static_cast<char>('x' + k);
  }
  const auto quiet = std::find_if(boundaries.begin(), boundaries.end(), [](const Boundary &b) { return b.quiet; });
  if (quiet == boundaries.end() || sinks.empty()) return;
  remarks->push_back("no boundary holds the weight along " + sinks + ": the dashpots of the quiet boundary '" +
                     quiet->name + "' hold nothing at rest, so the body sinks");
}

}  // namespace cdem
