#include "core/error.hpp"
#include "core/options.hpp"
#include "io/watch.hpp"

namespace cdem {

PetscErrorCode HistoryRecorder::ReadOptions(Options &options) {
  PetscFunctionBeginUser;
  PetscCall(options.Int("history_interval", &interval_));
  CdemCheck(interval_ > 0, options.comm(), "-history_interval is %lld; it must be at least 1",
            static_cast<long long>(interval_));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryRecorder::Open(MPI_Comm comm, const std::string &dir, const std::vector<History> &histories,
                                     bool append) {
  PetscFunctionBeginUser;
  comm_ = comm;
  histories_ = histories;
  PetscCallMPI(MPI_Comm_rank(comm, &rank_));
  if (Empty()) PetscFunctionReturn(PETSC_SUCCESS);
  std::vector<std::string> names;
  for (const History &h : histories_) names.push_back(h.name);
  origin_.assign(histories_.size(), 0.0);
  PetscCall(file_.Open(comm_, dir, names, append));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryRecorder::SetOrigin(const double *u) {
  PetscFunctionBeginUser;
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const History &h = histories_[i];
    if (h.slot >= 0 && h.component < 3) origin_[i] = u[3 * static_cast<std::size_t>(h.node) + h.component];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryRecorder::Write(const std::vector<PetscInt> &steps, const std::vector<double> &times,
                                      std::vector<double> &values) {
  PetscFunctionBeginUser;
  const int n = static_cast<int>(values.size());
  for (double &value : values) value += 0.0;  // -0 and 0 become one, whatever is added below
  // Each value is non-zero on the rank that owns its node alone, so the sum is that value to the last bit.
  PetscCallMPI(MPI_Reduce(rank_ == 0 ? MPI_IN_PLACE : values.data(), values.data(), n, MPI_DOUBLE, MPI_SUM, 0, comm_));
  std::vector<std::vector<double>> rows(steps.size());
  for (std::size_t r = 0; r < steps.size(); ++r)
    rows[r].assign(values.begin() + static_cast<std::ptrdiff_t>(r * histories_.size()),
                   values.begin() + static_cast<std::ptrdiff_t>((r + 1) * histories_.size()));
  PetscCall(file_.Append(steps, times, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryRecorder::Record(PetscInt first, const std::vector<double> &times, const double *buffer,
                                       int n_watch) {
  PetscFunctionBeginUser;
  std::vector<PetscInt> steps;
  std::vector<double> due_times, values;
  for (std::size_t j = 0; j < times.size(); ++j) {
    const PetscInt step = first + static_cast<PetscInt>(j);
    if (step % interval_ != 0) continue;
    steps.push_back(step);
    due_times.push_back(times[j]);
    for (std::size_t i = 0; i < histories_.size(); ++i) {
      const History &h = histories_[i];
      values.push_back(h.slot < 0 ? 0.0 : buffer[6 * (j * n_watch + h.slot) + h.component] - origin_[i]);
    }
  }
  PetscCall(Write(steps, due_times, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryRecorder::RecordLast(PetscInt step, double time, const double *u, const double *v_now) {
  PetscFunctionBeginUser;
  std::vector<double> values;
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const History &h = histories_[i];
    const std::size_t at = 3 * static_cast<std::size_t>(std::max(h.node, 0)) + h.component % 3;
    values.push_back(h.slot < 0 ? 0.0 : (h.component < 3 ? u[at] - origin_[i] : v_now[at]));
  }
  PetscCall(Write({step}, {time}, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
