// Corners and faces of the element shapes, in gmsh's (and VTK's) corner order. Faces list their corners
// counter-clockwise seen from outside.
#pragma once
#include <cstdint>

namespace cdem {

enum class Shape : std::uint8_t { kTet, kWedge, kHex };
inline constexpr int kShapes = 3;
inline constexpr int kMaxCorners = 8;
inline constexpr int kMaxFaces = 6;

struct ShapeInfo {
  const char *name;
  int corners, faces;
  int vtk_type;
  int face_size[kMaxFaces];
  int face[kMaxFaces][4];
};

inline constexpr ShapeInfo kShapeInfo[kShapes] = {
    {"tet4", 4, 4, 10, {3, 3, 3, 3, 0, 0}, {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}}},
    {"wedge6", 6, 5, 13, {3, 3, 4, 4, 4, 0}, {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}}},
    {"hex8",
     8,
     6,
     12,
     {4, 4, 4, 4, 4, 4},
     {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}}}};

inline constexpr const ShapeInfo &Info(Shape shape) { return kShapeInfo[static_cast<int>(shape)]; }

}  // namespace cdem
