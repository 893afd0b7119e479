#include "forces/input_bound.hpp"

#include <cmath>

namespace cdem {

PetscErrorCode InputBound::Begin(const Tables &t) {
  PetscFunctionBeginUser;
  const std::size_t n = static_cast<std::size_t>(t.n_tables);
  std::vector<double> squares(1 + 3 * n, 0.0);
  const double g2 = t.gravity[0] * t.gravity[0] + t.gravity[1] * t.gravity[1] + t.gravity[2] * t.gravity[2];
  for (int i = 0; i < t.n_owned; ++i) {
    const double share = t.weight.empty() ? 1 : t.weight[i];
    squares[0] += t.mass[i] * share * share * g2;
  }
  const NodeRecords &r = t.records;
  for (std::size_t i = 0; i < r.of_node.size(); ++i) {
    const int row = r.of_node[i];
    if (row < 0) continue;
    for (int l = r.load_start[row]; l < r.load_start[row + 1]; ++l)
      for (int k = 0; k < 3; ++k) {
        const double f = r.load[3 * static_cast<std::size_t>(l) + k];
        squares[1 + r.load_table[l]] += f * f * t.inverse_mass[i];
      }
    for (int k = 0; k < 3; ++k) {
      const int kind = (r.kind[row] >> (2 * k)) & 3;
      const std::size_t at = 3 * static_cast<std::size_t>(row) + k;
      const double square = t.mass[i] * r.value[at] * r.value[at];
      if (kind == kVelocity) squares[1 + n + r.table[at]] += square;
      if (kind == kDisplacement) squares[1 + 2 * n + r.table[at]] += square;
    }
  }
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, squares.data(), static_cast<int>(squares.size()), MPI_DOUBLE, MPI_SUM, t.comm));
  for (double &s : squares) s = std::sqrt(s);
  *this = InputBound();
  weight_ = squares[0];
  const auto at = squares.begin() + 1;
  const auto m = static_cast<std::ptrdiff_t>(n);
  force_.assign(at, at + m);
  velocity_.assign(at + m, at + 2 * m);
  place_.assign(at + 2 * m, at + 3 * m);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InputBound::Add(double dt, int n, const double *schedule) {
  double sum = dt * weight_ * n;
  for (int j = 0; schedule && j < n; ++j)
    for (std::size_t k = 0; k < force_.size(); ++k, schedule += 3) {
      const double jump = fresh_ && j == 0 ? std::fabs(schedule[0]) : 0;
      sum += dt * force_[k] * std::fabs(schedule[0]) + 2 * velocity_[k] * std::fabs(schedule[1]) +
             2 / dt * place_[k] * (std::fabs(schedule[2] - schedule[0]) + jump);
    }
  fresh_ = false;
  root_ += sum / std::sqrt(2.0);
}

double InputBound::Energy(double at_start) const {
  const double root = std::sqrt(at_start) + root_;
  return root * root;
}

}  // namespace cdem
