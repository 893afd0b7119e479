#include "core/error.hpp"
#include "core/options.hpp"
#include "io/watch.hpp"

namespace cdem {

namespace {

PetscErrorCode PrintProgress(PetscViewer viewer, const Sight &s) {
  PetscFunctionBeginUser;
  const double done = static_cast<double>(s.step - s.first_step);
  const double rate = s.wall > 0 ? s.elements * done / s.wall : 0;
  char left[64] = "";
  if (s.last_step < PETSC_INT_MAX && done > 0)
    std::snprintf(left, sizeof left, "  %5.1f %%  %.3g s left",
                  100.0 * static_cast<double>(s.step) / static_cast<double>(s.last_step),
                  s.wall * static_cast<double>(s.last_step - s.step) / done);
  PetscCall(PetscViewerASCIIPrintf(viewer, "step %8lld  time %.6e s  wall %.3g s  %.3g M element-steps/s%s\n",
                                   static_cast<long long>(s.step), s.time, s.wall, rate / 1e6, left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// kinetic, strain, spring: form and momentum come behind them.
constexpr std::size_t kStoredEnergies = 3;

PetscErrorCode PrintEnergy(PetscViewer viewer, const Sight &s) {
  PetscFunctionBeginUser;
  const Observed &o = s.observed;
  PetscCall(PetscViewerASCIIPrintf(viewer, "%lld %.17g", static_cast<long long>(s.step), s.time));
  for (std::size_t i = 0; i < s.energies.size(); ++i) {
    if (i == kStoredEnergies)
      PetscCall(PetscViewerASCIIPrintf(viewer, " %.17g %.17g %.17g %.17g", o.form, o.momentum[0], o.momentum[1],
                                       o.momentum[2]));
    PetscCall(PetscViewerASCIIPrintf(viewer, " %.17g", s.energies[i].value));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PrintConvergence(PetscViewer viewer, const Sight &s) {
  PetscFunctionBeginUser;
  const Observed &o = s.observed;
  PetscCall(PetscViewerASCIIPrintf(viewer, "%lld %.17g %.17g %.17g %lld", static_cast<long long>(s.step), s.time,
                                   o.kinetic, o.Unbalanced(), static_cast<long long>(o.broken)));
  if (s.breakable > 0) PetscCall(PetscViewerASCIIPrintf(viewer, " %.17g", o.broken_elements / s.breakable));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

const MonitorRow kMonitors[] = {
    {"monitor_progress", nullptr, false, PrintProgress},
    {"monitor_energy", "# step time kinetic strain spring form momentum_x momentum_y momentum_z", true, PrintEnergy,
     nullptr, true},
    {"monitor_convergence", "# step time kinetic unbalanced broken", true, PrintConvergence, " broken_blocks"},
};
const int kMonitorCount = 3;

PetscErrorCode SumOverRanks(MPI_Comm comm, Observed *o) {
  PetscFunctionBeginUser;
  double sum[] = {o->kinetic,     o->strain,          o->spring,         o->form,      o->momentum[0], o->momentum[1],
                  o->momentum[2], o->residual_sum,    o->residual_count, o->force_sum, o->force_count, o->broken,
                  o->springs,     o->broken_elements, o->load_u};
  double most[] = {o->v_max2, o->u_max2};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 15, MPI_DOUBLE, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, comm));
  *o = Observed{sum[0],  sum[1],  sum[2],  sum[3],  {sum[4], sum[5], sum[6]},
                sum[7],  sum[8],  sum[9],  sum[10], sum[11],
                sum[12], most[0], most[1], sum[13], sum[14]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

Monitors::~Monitors() {
  for (Active &a : active_) (void)PetscViewerDestroy(&a.viewer);
}

PetscErrorCode ReadInterval(Options &options, const std::string &prefix, Interval *interval) {
  PetscFunctionBeginUser;
  bool by_steps, by_time;
  const std::string steps = prefix + "interval", time = prefix + "interval_time";
  PetscCall(options.Int(steps.c_str(), &interval->steps, &by_steps));
  PetscCall(options.Real(time.c_str(), &interval->seconds, &by_time));
  CdemCheck(!by_steps || interval->steps > 0, options.comm(), "-%s is %lld; it must be at least 1", steps.c_str(),
            static_cast<long long>(interval->steps));
  CdemCheck(!by_time || interval->seconds > 0, options.comm(), "-%s is %g; it must be above 0", time.c_str(),
            interval->seconds);
  if (by_time && !by_steps) interval->steps = 0;  // a default in steps gives way
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Monitors::ReadOptions(Options &options, PetscInt last_step) {
  PetscFunctionBeginUser;
  for (int i = 0; i < kMonitorCount; ++i) {
    const MonitorRow &row = kMonitors[i];
    bool has;
    PetscCall(options.Has(row.option, &has));
    if (!has) continue;
    Active a{&row, nullptr, PETSC_VIEWER_DEFAULT, Interval()};
    a.interval.steps = row.observes ? 100 : (last_step < PETSC_INT_MAX ? std::max<PetscInt>(1, last_step / 20) : 1000);
    PetscCall(ReadInterval(options, std::string(row.option) + "_", &a.interval));
    active_.push_back(a);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Monitors::Open(MPI_Comm comm, bool breakable, const std::string &energies) {
  PetscFunctionBeginUser;
  std::vector<Active> open;
  for (Active &a : active_) {
    const std::string option = std::string("-") + a.row->option;
    char text[PETSC_MAX_PATH_LEN] = "";
    PetscBool set, on = PETSC_TRUE;
    PetscCall(PetscOptionsGetString(nullptr, nullptr, option.c_str(), text, sizeof text, &set));
    const std::string value = text;
    if (value == "true" || value == "false") {  // what YAML makes of a switch
      PetscCall(PetscOptionsGetBool(nullptr, nullptr, option.c_str(), &on, &set));
      if (!on) continue;
      PetscCall(PetscViewerASCIIGetStdout(comm, &a.viewer));
      PetscCall(PetscObjectReference(reinterpret_cast<PetscObject>(a.viewer)));
    } else {
      PetscCall(ViewerFromOption(comm, option.c_str(), &a.viewer, &a.format, &set));
      if (!set || !a.viewer) continue;
    }
    const char *more = breakable && a.row->of_breakable ? a.row->of_breakable : "";
    if (a.row->header)
      PetscCall(
          PetscViewerASCIIPrintf(a.viewer, "%s%s%s\n", a.row->header, more, a.row->audits ? energies.c_str() : ""));
    open.push_back(a);
  }
  active_ = open;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt Monitors::ToNext(PetscInt step, double time, double dt) const {
  PetscInt n = PETSC_INT_MAX;
  for (const Active &a : active_) n = std::min(n, a.interval.ToNext(step, time, dt));
  return n;
}

bool Monitors::Due(PetscInt step, double time, double dt, bool last) const {
  for (const Active &a : active_)
    if (last || a.interval.Due(step, time, dt)) return true;
  return false;
}

bool Monitors::Observes(PetscInt step, double time, double dt, bool last) const {
  for (const Active &a : active_)
    if (a.row->observes && (last || a.interval.Due(step, time, dt))) return true;
  return false;
}

bool Monitors::Audits(PetscInt step, double time, double dt, bool last) const {
  for (const Active &a : active_)
    if (a.row->audits && (last || a.interval.Due(step, time, dt))) return true;
  return false;
}

PetscErrorCode Monitors::Print(const Sight &sight, double dt, bool last) {
  PetscFunctionBeginUser;
  for (Active &a : active_) {
    if (!last && !a.interval.Due(sight.step, sight.time, dt)) continue;
    PetscCall(PetscViewerPushFormat(a.viewer, a.format));
    PetscCall(a.row->print(a.viewer, sight));
    PetscCall(PetscViewerPopFormat(a.viewer));
    PetscCall(PetscViewerFlush(a.viewer));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
