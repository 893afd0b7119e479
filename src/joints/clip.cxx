#include "joints/clip.hpp"

#include "core/small.hpp"
#include "mesh/geometry.hpp"

#include <limits>

namespace cdem {

namespace {

/// Area swept from p to q, seen from the origin, inside a circle that holds all of the way, or nothing of it.
double Sweep(const double p[2], const double q[2], bool inside, double radius2) {
  const double cross = p[0] * q[1] - p[1] * q[0];
  return inside ? 0.5 * cross : 0.5 * radius2 * std::atan2(cross, p[0] * q[0] + p[1] * q[1]);
}

/// A disc with the axes of its plane.
struct Plane {
  const Disc &disc;
  double e[2][3];
  explicit Plane(const Disc &d) : disc(d) { PlaneBasis(d.normal, e[0], e[1]); }
  double Distance(const double x[3]) const {
    const double r[3] = {x[0] - disc.centre[0], x[1] - disc.centre[1], x[2] - disc.centre[2]};
    return Dot(disc.normal, r);
  }
  void Project(const double x[3], double y[2]) const {
    const double r[3] = {x[0] - disc.centre[0], x[1] - disc.centre[1], x[2] - disc.centre[2]};
    for (int i = 0; i < 2; ++i) y[i] = Dot(e[i], r);
  }
};

/// Disc inside a tetrahedron; d: signed distances of its corners from the plane.
double DiscInTet(const Plane &plane, const double *const x[4], const double d[4]) {
  int above[4], below[4], n_above = 0, n_below = 0;
  for (int i = 0; i < 4; ++i) (d[i] > 0 ? above[n_above++] : below[n_below++]) = i;
  if (n_above == 0 || n_below == 0) return 0;
  double section[4][2];
  auto cut = [&](int a, int b, double y[2]) {  // where the edge from above to below meets the plane
    const double t = d[a] / (d[a] - d[b]);
    double at[3];
    for (int k = 0; k < 3; ++k) at[k] = x[a][k] + t * (x[b][k] - x[a][k]);
    plane.Project(at, y);
  };
  if (n_above == 2) {
    cut(above[0], below[0], section[0]);
    cut(above[0], below[1], section[1]);
    cut(above[1], below[1], section[2]);
    cut(above[1], below[0], section[3]);
    return CircleInPolygon(4, section, plane.disc.radius);
  }
  for (int i = 0; i < 3; ++i) cut(n_above == 1 ? above[0] : above[i], n_above == 1 ? below[i] : below[0], section[i]);
  return CircleInPolygon(3, section, plane.disc.radius);
}

}  // namespace

double CircleInPolygon(int corners, const double (*x)[2], double radius) {
  const double radius2 = radius * radius;
  double area = 0;
  for (int i = 0; i < corners; ++i) {
    const double *p = x[i], *q = x[(i + 1) % corners];
    const double s[2] = {q[0] - p[0], q[1] - p[1]};
    const double a = s[0] * s[0] + s[1] * s[1], b = p[0] * s[0] + p[1] * s[1], c = p[0] * p[0] + p[1] * p[1] - radius2,
                 root2 = b * b - a * c;
    double enter = 2, leave = 2, t[4] = {0, 1, 1, 1};  // where the edge's line meets the circle; a tangent does not
    int n = 1;
    if (a > 0 && root2 > 0) {
      const double root = std::sqrt(root2);
      enter = (-b - root) / a;
      leave = (-b + root) / a;
      for (const double at : {enter, leave})
        if (at > 0 && at < 1) t[n++] = at;
    }
    t[n] = 1;
    for (int j = 0; j < n; ++j) {
      const double middle = 0.5 * (t[j] + t[j + 1]);
      const double from[2] = {p[0] + t[j] * s[0], p[1] + t[j] * s[1]},
                   to[2] = {p[0] + t[j + 1] * s[0], p[1] + t[j + 1] * s[1]};
      area += Sweep(from, to, middle > enter && middle < leave, radius2);
    }
  }
  return std::fabs(area);
}

/// A cell other than a tetrahedron is cut into tetrahedra between its centre, the centre of a face and an edge: neighbours
/// cut a warped face alike, so that no part of the disc is lost or counted twice.
double DiscInCell(const Mesh &mesh, PetscInt cell, const Disc &disc) {
  const ShapeInfo &info = Info(mesh.cell_shape[cell]);
  const PetscInt *corner = mesh.Corners(cell);
  const Plane plane(disc);
  const double *x[kMaxCorners];
  double d[kMaxCorners];
  int n_above = 0;
  for (int a = 0; a < info.corners; ++a) {
    x[a] = mesh.X(corner[a]);
    d[a] = plane.Distance(x[a]);
    n_above += d[a] > 0;
  }
  if (n_above == 0 || n_above == info.corners) return 0;
  if (info.corners == 4) return DiscInTet(plane, x, d);
  double centre[3], area = 0;
  CellCentre(mesh, cell, centre);
  const double d_centre = plane.Distance(centre);
  for (int f = 0; f < info.faces; ++f) {
    const int size = info.face_size[f];
    const int *at = info.face[f];
    if (size == 3) {
      const double *tet[4] = {x[at[0]], x[at[1]], x[at[2]], centre};
      const double distance[4] = {d[at[0]], d[at[1]], d[at[2]], d_centre};
      area += DiscInTet(plane, tet, distance);
      continue;
    }
    double middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = 0.25 * ((x[at[0]][k] + x[at[2]][k]) + (x[at[1]][k] + x[at[3]][k]));
    const double d_middle = plane.Distance(middle);
    for (int j = 0; j < 4; ++j) {
      const int a = at[j], b = at[(j + 1) % 4];
      const double *tet[4] = {x[a], x[b], middle, centre};
      const double distance[4] = {d[a], d[b], d_middle, d_centre};
      area += DiscInTet(plane, tet, distance);
    }
  }
  return area;
}

PetscErrorCode Region::Create(const Mesh &mesh, int region) {
  PetscFunctionBeginUser;
  mesh_ = &mesh;
  double box[6], reach = 0, volumes[kMaxCorners], x[kMaxCorners][3];
  std::fill_n(box, 6, std::numeric_limits<double>::max());  // lower, minus upper
  std::vector<double> centres, cell_volume;
  for (PetscInt c = 0; c < mesh.n_owned; ++c) {
    if (region >= 0 && mesh.cell_region[c] != region) continue;
    double centre[3];
    CellCentre(mesh, c, centre);
    const int corners = CellCorners(mesh, c, x);
    for (int a = 0; a < corners; ++a) {
      double away = 0;
      for (int k = 0; k < 3; ++k) {
        box[k] = std::min(box[k], x[a][k]);
        box[3 + k] = std::min(box[3 + k], -x[a][k]);
        away += (x[a][k] - centre[k]) * (x[a][k] - centre[k]);
      }
      reach = std::max(reach, std::sqrt(away));
    }
    cell_volume.push_back(CornerVolumes(mesh.cell_shape[c], x, volumes));
    centres.insert(centres.end(), centre, centre + 3);
    cell_.push_back(c);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, 6, MPI_DOUBLE, MPI_MIN, mesh.comm));
  double box_volume = 1;
  for (int k = 0; k < 3; ++k) {
    lower[k] = box[k];
    upper[k] = -box[3 + k];
    box_volume *= upper[k] - lower[k];
  }
  // Whole numbers add up to the same in any order, which floating-point numbers of several ranks would not.
  const double unit = box_volume * 0x1p-60;
  std::int64_t sum = 0;
  for (const double v : cell_volume) sum += std::llround(v / unit);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT64_T, MPI_SUM, mesh.comm));
  volume = static_cast<double>(sum) * unit;
  bins_.Fill(centres, reach);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Region::Clip(std::vector<Disc> *discs) const {
  PetscFunctionBeginUser;
  constexpr double kPi = 3.14159265358979323846;
  std::vector<std::int64_t> share(discs->size(), 0);  // of the disc's area, in whole numbers of 2^-50
  for (std::size_t i = 0; i < discs->size(); ++i) {
    const Disc &disc = (*discs)[i];
    const double whole = kPi * disc.radius * disc.radius;
    bins_.Near(disc, [&](std::size_t c) {
      const double area = DiscInCell(*mesh_, cell_[c], disc);
      if (area > 0) share[i] += std::llround(area / whole * 0x1p50);
    });
  }
  for (std::size_t i = 0; i < share.size(); i += 1 << 20)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &share[i],
                               static_cast<int>(std::min<std::size_t>(1 << 20, share.size() - i)), MPI_INT64_T, MPI_SUM,
                               mesh_->comm));
  for (std::size_t i = 0; i < share.size(); ++i) {
    Disc &disc = (*discs)[i];
    disc.inside = static_cast<double>(share[i]) * 0x1p-50 * (kPi * disc.radius * disc.radius);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
