// Integrals over elements and faces on the host, for set-up.
#pragma once
#include "mesh/shapes.hpp"

namespace cdem {

/// Row-sum volumes of an element's corners: integral of N_a over the element [m^3], exact for these shapes.
/// [in] x: [corners][3]. Returns the element's volume.
double CornerVolumes(Shape shape, const double (*x)[3], double *volume);

/// Gradient of a field with corner values u, averaged over the Gauss points: g[i][j] = d u_i / d x_j.
void MeanGradient(Shape shape, const double (*x)[3], const double (*u)[3], double (*g)[3]);

/// Integrals of N_j n dA over a face of 3 or 4 corners [m^2], exact for warped quadrilaterals too.
/// [in] x: [size][3] counter-clockwise seen from the tip of n. [out] area: [size][3].
void FaceVectors(int size, const double (*x)[3], double (*area)[3]);

/// Quadrature points of a face: barycentric or bilinear shape functions and the area vector with its weight.
struct FacePoint {
  double shape[4];
  double area[3];
};
/// [out] points: up to 4. Returns their number.
int FacePoints(int size, const double (*x)[3], FacePoint *points);

}  // namespace cdem
