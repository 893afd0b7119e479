// The energy audit's memory as rows in one order over all ranks, for checkpoints: elements by global cell, springs of one
// law by (global cell, local face, corner), nodes by global number.
#pragma once
#include "io/history_rows.hpp"

namespace cdem {

/// Rows of one dataset: those that this rank gives to a file, and those that it wants from one.
struct AuditRows {
  std::string name;
  int width = 0;           ///< doubles a row
  std::int64_t total = 0;  ///< rows over all ranks
  std::vector<std::int64_t> given, wanted;
  int spring_table = -1;  ///< of springs: of this rank, -1: it has none
  bool springs = false, nodes = false;
};

/// The datasets of a scene, the same on all ranks (collective).
PetscErrorCode FindAuditRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables, std::vector<AuditRows> *rows);
/// Values of the given rows, [row][number].
std::vector<double> TakeAuditRows(const AuditRows &rows, const Mesh &mesh, const Tables &tables,
                                  const AuditArrays &arrays);
/// [in] values: of the wanted rows. Nodes are the owned ones: their ghosts come by a halo.
void PutAuditRows(const AuditRows &rows, const Tables &tables, const std::vector<double> &values, AuditArrays *arrays);
/// Brings what nodes remember to their ghosts (collective).
PetscErrorCode ShareAudit(const Tables &tables, AuditArrays *arrays);

}  // namespace cdem
