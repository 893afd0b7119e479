// The histories of elements and springs as rows in one order over all ranks: elements of one shape, form and law by global
// cell, springs of one law by (global cell, local face, corner).
#pragma once
#include "forces/backend.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

/// All rows of one kind. It exists on every rank, whether or not the rank has any of them.
struct HistoryRows {
  std::string name;                  ///< "elements_hex8_full_breakage", "springs_brittle_3"
  bool springs = false;              ///< else elements
  bool timed = false;                ///< elements with a time of breaking
  int table = -1;                    ///< of Tables::elements or springs of this rank; -1: it has none of them
  int states = 0;                    ///< doubles a row
  int places = 1;                    ///< integers that say where: global cell; of springs cell, face, corner
  std::int64_t total = 0;            ///< rows over all ranks
  std::vector<int> given;            ///< rows of the table of which this rank speaks for all
  std::vector<std::int64_t> number;  ///< [rows of the table] place in the order over all ranks
  std::vector<std::int64_t> place;   ///< [rows of the table][places]
};

/// Finds the rows of all kinds that have history, the same kinds in the same order on all ranks (collective).
PetscErrorCode FindHistoryRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                               std::vector<HistoryRows> *kinds);

/// The same for the springs of all laws, with history or without.
PetscErrorCode FindSpringRows(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                              std::vector<HistoryRows> *kinds);

/// Rows of a table as the file has them, [row][number], and back.
struct HistoryData {
  std::vector<std::uint8_t> state;
  std::vector<double> value, broken_time;
};
HistoryData TakeRows(const HistoryRows &kind, const Histories &history, const std::vector<int> &rows);
/// [in] data: of all rows of the table. Padded rows become copies of the last one.
void PutRows(const HistoryRows &kind, const HistoryData &data, Histories *history);

}  // namespace cdem
