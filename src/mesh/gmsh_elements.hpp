// The kinds of elements in gmsh files.
#pragma once
#include "mesh/gmsh_text.hpp"

namespace cdem {

struct ElementType {
  int type, dim, nodes, order;  // order: PETSc numbers the cells by kind, then as they come in the file
};
inline constexpr ElementType kGmshTypes[] = {{15, 0, 1, 0}, {1, 1, 2, 0}, {2, 2, 3, 0}, {3, 2, 4, 0},
                                             {4, 3, 4, 0},  {5, 3, 8, 1}, {6, 3, 6, 2}};

/// Throws GmshError for what cdem does not take.
inline const ElementType &FindType(const GmshText &text, std::int64_t type) {
  for (const ElementType &known : kGmshTypes) {
    if (known.type == type) return known;
  }
  const std::string number = std::to_string(type);
  if (type == 7) text.Fail("holds pyramids; only tetrahedra, hexahedra and wedges are possible: mesh without pyramids");
  if ((type >= 8 && type <= 14) || (type >= 16 && type <= 19)) {
    text.Fail("holds second-order elements (gmsh type " + number + "): mesh again with Mesh.ElementOrder = 1");
  }
  text.Fail("holds elements of gmsh type " + number +
            "; only linear tetrahedra, hexahedra and wedges are possible "
            "(Mesh.ElementOrder = 1)");
}

/// "volume 3", as gmsh calls its entities.
inline std::string EntityName(int dim, int entity) {
  const char *const name[] = {"point", "curve", "surface", "volume"};
  return (dim >= 0 && dim < 4 ? name[dim] : "entity of dimension " + std::to_string(dim)) +
         (" " + std::to_string(entity));
}

}  // namespace cdem
