#include "forces/host_gather.hpp"
#include "forces/host_passes.hpp"
#include "forces/spring_audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cdem {

namespace {

/// What the energy of a spring is made of, for one of the lanes.
template <class Law>
Spring<double> OneLane(const Spring<Lanes> &s, int l) {
  Spring<double> one{};
  for (int k = 0; k < 3; ++k) one.normal[k] = s.normal[k][l], one.d[k] = s.d[k][l];
  one.kn = s.kn[l];
  one.ks = s.ks[l];
  for (int k = 0; k < Law::kState; ++k) one.history[k] = s.history[k][l];
  return one;
}

/// Adds what a step dissipated in the springs from i on. [in] s: as it was before the evaluation; outcome, history: of it;
/// force: total [N].
template <class Law, bool kBeta>
void AuditSprings(const AuditPass &audit, const SpringTable &t, int i, int index, const double *v,
                  const Spring<Lanes> &s, const Outcome<Lanes> &outcome, const Lanes *history,
                  const std::uint8_t *state, const Lanes force[3]) {
  const std::size_t stride = t.n_pad;
  if constexpr (kDissipates<Law> && !kBeta) {  // most springs are whole, and stay so
    bool whole = !Any(outcome.changed);
    for (int l = 0; l < kLanes; ++l) whole &= state[l] == 0;
    if (whole) return;
  }
  Lanes work[kSpringWorks] = {}, step[3] = {}, lawful[3] = {force[0], force[1], force[2]};
  Spring<Lanes> again = s;
  if (kBeta) SpringForce<Law, false>(again, lawful);  // without its viscous part
  MaskOf<Lanes> may{};
  SpringBefore<Lanes> before;
  if constexpr (kDissipates<Law>) {
    for (int k = 0; k < Law::kState; ++k) before.history[k] = s.history[k];
    for (int l = 0; l < kLanes; ++l) {
      before.open[l] = state[l] & kOpen ? -1 : 0;
      before.tension_lost[l] = state[l] & kTensionLost ? -1 : 0;
      before.any[l] = state[l] ? -1 : 0;
    }
    may = MayDissipate<Law>(before, outcome);
  }
  if (kBeta || Any(may)) {
    Lanes at[3];
    Gather(v, &t.b[i], step);
    Gather(v, &t.a[i], at);
    for (int k = 0; k < 3; ++k) step[k] = audit.dt * (step[k] - at[k]);
  }
  if constexpr (kDissipates<Law>)
    if (Any(may)) {
      again = s;
      for (int k = 0; k < Law::kState; ++k) again.history[k] = history[k];
      SpringDissipation<Law>(again, before, outcome, lawful, step, work);
    }
  if (kBeta) {
    std::vector<double> &viscous = audit.arrays->viscous[index];
    for (int k = 0; k < 3; ++k) {
      const Lanes now = force[k] - lawful[k];
      work[kSpringBeta] -= 0.5 * (LoadAs<Lanes>(&viscous[k * stride + i]) + now) * step[k];
      StoreAs(&viscous[k * stride + i], now);
    }
  }
  if (!kBeta && !Any(may)) return;
  std::vector<double> &sums = audit.arrays->spring[index];
  for (int k = 0; k < kSpringWorks; ++k) StoreAs(&sums[k * stride + i], LoadAs<Lanes>(&sums[k * stride + i]) + work[k]);
}

bool StatesAreZero(const std::uint8_t *state) {
  std::uint64_t all = 0;
  std::memcpy(&all, state, kLanes);
  return all == 0;
}

/// What springs i to i + kLanes - 1 lost, and their numbers; of fresh ones nothing is read.
template <class Law>
void LoadHistory(const SpringHistory &history, std::size_t stride, int i, bool fresh, Spring<Lanes> *s) {
  s->tension_lost = s->cohesion_lost = Lanes{};
  for (int k = 0; k < Law::kState; ++k) s->history[k] = Lanes{};
  if (fresh) return;
  for (int l = 0; l < kLanes; ++l) {
    s->tension_lost[l] = history.state[i + l] & kTensionLost ? 1 : 0;
    s->cohesion_lost[l] = history.state[i + l] & kCohesionLost ? 1 : 0;
  }
  for (int k = 0; k < Law::kState; ++k) s->history[k] = LoadAs<Lanes>(&history.values[k * stride + i]);
}

template <class Law, bool kBeta, bool kCommit, bool kAudit = false>
void SpringLoop(const Tables &tables, const SpringTable &t, const double *u, const double *v, double beta,
                SpringHistory *history, double *f, SpringResults *results, int index,
                const AuditPass *audit = nullptr) {
  const std::size_t stride = t.n_pad;
  for (int i = 0; i < t.n; i += kLanes) {
    Spring<Lanes> s;
    Lanes param[kMaxParams], at[3], force[3];
    bool fresh = true;  // nothing ever happened to these springs
    Gather(u, &t.b[i], s.d);
    Gather(u, &t.a[i], at);
    for (int k = 0; k < 3; ++k) s.d[k] -= at[k];
    if (kBeta) {
      Gather(v, &t.b[i], s.beta_rate);
      Gather(v, &t.a[i], at);
      for (int k = 0; k < 3; ++k) s.beta_rate[k] = beta * (s.beta_rate[k] - at[k]);
    }
    for (int k = 0; k < 3; ++k) s.normal[k] = LoadAs<Lanes>(&t.normal[k * stride + i]);
    s.kn = LoadAs<Lanes>(&t.kn[i]);
    s.ks = LoadAs<Lanes>(&t.ks[i]);
    if constexpr (Law::kHistory) {
      s.area = LoadAs<Lanes>(&t.area[i]);
      LoadParams(tables.joint_param, &t.joint[i], Law::kParams, param);
      s.param = param;
      fresh = StatesAreZero(&history->state[i]);
      LoadHistory<Law>(*history, stride, i, fresh, &s);
    }
    Spring<Lanes> before;
    if constexpr (kAudit) before = s;
    const Outcome<Lanes> outcome = SpringForce<Law, kBeta>(s, force);
    if constexpr (kAudit) {
      const std::uint8_t *state = Law::kHistory ? &history->state[i] : nullptr;
      AuditSprings<Law, kBeta>(*audit, t, i, index, v, before, outcome, s.history, state, force);
    }

    std::uint8_t next[kLanes] = {};
    if constexpr (Law::kHistory) {
      const LaneMask bits = StateBits(outcome);
      if (!fresh || Any(bits)) {
        for (int l = 0; l < kLanes; ++l) next[l] = NextState(history->state[i + l], bits[l]);
        if (kCommit) {
          std::copy_n(next, kLanes, &history->state[i]);
          if (Any(outcome.changed))
            for (int k = 0; k < Law::kState; ++k) StoreAs(&history->values[k * stride + i], s.history[k]);
        }
      }
    }
    alignas(sizeof(Lanes)) double out[3][kLanes];
    for (int k = 0; k < 3; ++k) StoreAs(out[k], force[k]);
    const int live = std::min(kLanes, t.n - i);
    for (int l = 0; l < live; ++l) {
      double *to_a = f + 3 * static_cast<std::ptrdiff_t>(t.a[i + l]),
             *to_b = f + 3 * static_cast<std::ptrdiff_t>(t.b[i + l]);
      for (int k = 0; k < 3; ++k) to_a[k] += out[k][l];
      for (int k = 0; k < 3; ++k) to_b[k] -= out[k][l];
      if (kCommit) continue;
      if (results->want_each)
        for (int k = 0; k < 3; ++k) results->force[index][k * stride + i + l] = out[k][l];
      if (results->want_each) results->state[index][i + l] = next[l];
      if (!t.counted[i + l]) continue;
      const double one[3] = {out[0][l], out[1][l], out[2][l]};
      const double energy = Law::Energy(OneLane<Law>(s, l), one);
      results->energy += energy;
      if (results->want_energies) results->each[index][i + l] = energy;
      for (int k = 0; k < 3; ++k) results->force_sum += std::fabs(one[k]);
      results->force_count += 3;
      results->count += 1;
      results->broken += (next[l] & kCohesionLost) != 0;
    }
  }
}

template <bool kBeta, bool kCommit>
void Springs(const Tables &tables, const double *u, const double *v, double beta, std::vector<SpringHistory> &history,
             double *f, SpringResults *results, const AuditPass *audit = nullptr) {
  for (std::size_t g = 0; g < tables.springs.size(); ++g)
    JointLaws::Visit(tables.springs[g].law, [&](auto law) {
      using Law = decltype(law);
      const SpringTable &t = tables.springs[g];
      const int index = static_cast<int>(g);
      if constexpr (kCommit && (kDissipates<Law> || kBeta))
        if (audit && Audits(tables, t)) {
          SpringLoop<Law, kBeta, true, true>(tables, t, u, v, beta, &history[g], f, results, index, audit);
          return;
        }
      SpringLoop<Law, kBeta, kCommit>(tables, t, u, v, beta, &history[g], f, results, index);
    });
}

}  // namespace

void HostSprings(const Tables &tables, const double *u, const double *v, double beta,
                 std::vector<SpringHistory> &history, double *f, const AuditPass *audit) {
  if (beta != 0)
    Springs<true, true>(tables, u, v, beta, history, f, nullptr, audit);
  else
    Springs<false, true>(tables, u, v, beta, history, f, nullptr, audit);
}

void HostSpringsObserve(const Tables &tables, const double *u, const double *v, double beta,
                        const std::vector<SpringHistory> &history, double *f, SpringResults *results) {
  if (results->want_energies) {
    results->each.clear();
    for (const SpringTable &t : tables.springs) results->each.emplace_back(t.n_pad, 0.0);
  }
  if (results->want_each) {
    results->force.resize(tables.springs.size());
    results->state.resize(tables.springs.size());
    for (std::size_t g = 0; g < tables.springs.size(); ++g) {
      results->force[g].assign(3 * static_cast<std::size_t>(tables.springs[g].n_pad), 0.0);
      results->state[g].assign(tables.springs[g].n_pad, 0);
    }
  }
  auto &unchanged = const_cast<std::vector<SpringHistory> &>(history);  // a pass that does not commit only reads
  if (beta != 0)
    Springs<true, false>(tables, u, v, beta, unchanged, f, results);
  else
    Springs<false, false>(tables, u, v, beta, unchanged, f, results);
}

std::vector<SpringHistory> StartSprings(const Tables &tables) {
  std::vector<SpringHistory> history(tables.springs.size());
  for (std::size_t g = 0; g < history.size(); ++g) {
    const SpringTable &t = tables.springs[g];
    if (t.state.empty()) continue;
    history[g].state = t.state;
    history[g].values.assign(static_cast<std::size_t>(t.n_state) * t.n_pad, 0.0);
  }
  return history;
}

}  // namespace cdem
