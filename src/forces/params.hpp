// Rows of parameters: one for a region, or one for each of its elements where something scatters or depends on size.
#pragma once
#include "forces/tables.hpp"

namespace cdem {

/// Elements of the region have parameters of their own.
bool HasOwnParams(const Material &material);

/// Parameters of the law of a cell [kMaxParams], the same on every rank that asks.
void CellParams(const Mesh &mesh, const std::vector<Material> &materials, PetscInt cell, double *param);

/// The rows of the regions.
void StartBlockParams(const std::vector<Material> &materials, Tables *tables);

/// Gives the elements of a table that want them rows of their own; neighbours with equal parameters share one.
void AddOwnParams(const Mesh &mesh, const std::vector<Material> &materials, ElementTable *table, Tables *tables);

/// Properties [kMaxProperties], parameters [kMaxParams] and stiffness of an interface at a face, as they scatter.
bool HasOwnParams(const Joint &joint);
void FaceProperties(const Mesh &mesh, const Joint &joint, const Face &face, double *property);
void FaceParams(const Mesh &mesh, const Joint &joint, const Face &face, double *param);
void ScatterStiffness(const Mesh &mesh, const Joint &joint, const Face &face, double *kn, double *ks);

/// remarks receives regions with elements too large for their softening (collective).
PetscErrorCode CheckSizes(const Mesh &mesh, const std::vector<Material> &materials, std::vector<std::string> *remarks);

/// Elements whose properties, as they scatter, do not go together (collective).
PetscErrorCode CheckOwnParams(const Mesh &mesh, const std::vector<Material> &materials);

}  // namespace cdem
