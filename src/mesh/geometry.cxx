#include "mesh/geometry.hpp"

#include "core/small.hpp"

#include <cmath>

namespace cdem {

namespace {

constexpr double kGauss = 0.57735026918962576451;
constexpr int kHexSign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

struct Point {
  double n[8], dn[8][3], weight;
};

int Points(Shape shape, Point *p) {
  if (shape == Shape::kHex) {
    for (int g = 0; g < 8; ++g) {
      p[g].weight = 1;
      for (int a = 0; a < 8; ++a) {
        double f[3];
        for (int k = 0; k < 3; ++k) f[k] = 0.5 * (1 + kHexSign[a][k] * kHexSign[g][k] * kGauss);
        p[g].n[a] = f[0] * f[1] * f[2];
        for (int k = 0; k < 3; ++k) p[g].dn[a][k] = 0.5 * kHexSign[a][k] * f[(k + 1) % 3] * f[(k + 2) % 3];
      }
    }
    return 8;
  }
  if (shape == Shape::kWedge) {
    for (int g = 0; g < 6; ++g) {
      const double zeta = g < 3 ? -kGauss : kGauss, l1 = g % 3 == 1 ? 2.0 / 3 : 1.0 / 6,
                   l2 = g % 3 == 2 ? 2.0 / 3 : 1.0 / 6;
      const double l[3] = {1 - l1 - l2, l1, l2}, dl[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
      p[g].weight = 1.0 / 6;
      for (int a = 0; a < 6; ++a) {
        const double sign = a < 3 ? -1 : 1, height = 0.5 * (1 + sign * zeta);
        p[g].n[a] = l[a % 3] * height;
        p[g].dn[a][0] = dl[a % 3][0] * height;
        p[g].dn[a][1] = dl[a % 3][1] * height;
        p[g].dn[a][2] = 0.5 * sign * l[a % 3];
      }
    }
    return 6;
  }
  const double dn[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  p[0].weight = 1.0 / 6;
  for (int a = 0; a < 4; ++a) {
    p[0].n[a] = 0.25;
    for (int k = 0; k < 3; ++k) p[0].dn[a][k] = dn[a][k];
  }
  return 1;
}

}  // namespace

double CornerVolumes(Shape shape, const double (*x)[3], double *volume) {
  Point points[8];
  const int n_points = Points(shape, points), corners = Info(shape).corners;
  double total = 0;
  for (int a = 0; a < corners; ++a) volume[a] = 0;
  for (int g = 0; g < n_points; ++g) {
    double j[3][3] = {}, c[3];
    for (int a = 0; a < corners; ++a)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) j[i][k] += points[g].dn[a][i] * x[a][k];
    Cross(j[1], j[2], c);
    const double share = Dot(j[0], c) * points[g].weight;
    total += share;
    for (int a = 0; a < corners; ++a) volume[a] += share * points[g].n[a];
  }
  return total;
}

void MeanGradient(Shape shape, const double (*x)[3], const double (*u)[3], double (*g)[3]) {
  Point points[8];
  const int n_points = Points(shape, points), corners = Info(shape).corners;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) g[i][j] = 0;
  for (int p = 0; p < n_points; ++p) {
    double jacobian[3][3] = {}, du[3][3] = {}, cofactor[3][3];  // rows: derivatives along xi, eta, zeta
    for (int a = 0; a < corners; ++a)
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) {
          jacobian[r][k] += points[p].dn[a][r] * x[a][k];
          du[r][k] += points[p].dn[a][r] * u[a][k];
        }
    for (int r = 0; r < 3; ++r) Cross(jacobian[(r + 1) % 3], jacobian[(r + 2) % 3], cofactor[r]);
    const double scale = 1 / (n_points * Dot(jacobian[0], cofactor[0]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int r = 0; r < 3; ++r) g[i][j] += du[r][i] * cofactor[r][j] * scale;
  }
}

int FacePoints(int size, const double (*x)[3], FacePoint *points) {
  if (size == 3) {
    double e[2][3];
    for (int k = 0; k < 3; ++k) e[0][k] = x[1][k] - x[0][k], e[1][k] = x[2][k] - x[0][k];
    double c[3];
    Cross(e[0], e[1], c);
    for (int g = 0; g < 3; ++g) {
      for (int j = 0; j < 4; ++j) points[g].shape[j] = j == g ? 2.0 / 3 : (j < 3 ? 1.0 / 6 : 0);
      for (int k = 0; k < 3; ++k) points[g].area[k] = c[k] / 6;
    }
    return 3;
  }
  constexpr int sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int g = 0; g < 4; ++g) {
    const double r = kGauss * sign[g][0], s = kGauss * sign[g][1];
    double dr[3] = {}, ds[3] = {};
    for (int j = 0; j < 4; ++j) {
      points[g].shape[j] = 0.25 * (1 + sign[j][0] * r) * (1 + sign[j][1] * s);
      for (int k = 0; k < 3; ++k) {
        dr[k] += 0.25 * sign[j][0] * (1 + sign[j][1] * s) * x[j][k];
        ds[k] += 0.25 * sign[j][1] * (1 + sign[j][0] * r) * x[j][k];
      }
    }
    Cross(dr, ds, points[g].area);
  }
  return 4;
}

void FaceVectors(int size, const double (*x)[3], double (*area)[3]) {
  FacePoint points[4];
  const int n = FacePoints(size, x, points);
  for (int j = 0; j < size; ++j)
    for (int k = 0; k < 3; ++k) {
      area[j][k] = 0;
      for (int g = 0; g < n; ++g) area[j][k] += points[g].shape[j] * points[g].area[k];
    }
}

}  // namespace cdem
