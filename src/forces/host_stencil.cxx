#include "forces/host_stencil.hpp"

#include "forces/stencil_body.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr int kAll = (1 << kLanes) - 1;
constexpr int kTogether = 2;       ///< tiles for which a block of the stiffness is read once
constexpr double kMostWork = 0.6;  ///< tiles or single nodes for a node that moves, at which elements are as fast

/// The lanes of a mask of bits.
LaneMask MaskOfBits(int bits) {
  LaneMask mask;
  for (int l = 0; l < kLanes; ++l) mask[l] = bits >> l & 1 ? -1 : 0;
  return mask;
}

}  // namespace

std::string HostStencil::Create(const Tables &tables, bool any) {
  const std::string why = PlanStencil(tables, kPad, any, &plan_);
  if (!why.empty()) return why;
  beta_ = tables.beta;
  stride_ = Padded(plan_.node.size()) + kLanes;  // the last tile may reach beyond the last place
  const std::size_t n = 3 * stride_;
  v_.assign(n, 0.0), w_[0].assign(n, 0.0), w_[1].assign(n, 0.0);
  if (beta_ != 0) u_.assign(n, 0.0);
  int work = 0;
  for (int of = 0; of < static_cast<int>(plan_.classes.size()); ++of) {
    MakeTiles(of);
    work += work_.back().end - work_.back().full + work_.back().one_end - work_.back().one_begin;
  }
  return !any && work > kMostWork * plan_.moving ? "few nodes follow each other" : "";
}

/// Lanes over the places of a class by offsets, across those of other classes, which lie between.
void HostStencil::MakeTiles(int of) {
  const StencilClass &c = plan_.classes[of];
  Work work{of, static_cast<int>(tile_.size()), 0, 0, c.begin, c.end};
  if (c.list < 0 && !c.records) {
    work.one_begin = work.one_end;
    for (int p = c.begin; p < c.end && plan_.position[p] >= 0;) {
      Tile tile{plan_.position[p], 0};
      for (; p < c.end && plan_.position[p] >= 0 && plan_.position[p] < tile.place + kLanes; ++p)
        tile.mask |= 1 << (plan_.position[p] - tile.place);
      tile_.push_back(tile);
    }
    std::stable_partition(tile_.begin() + work.full, tile_.end(), [](const Tile &t) { return t.mask == kAll; });
  }
  work.part = work.full;
  work.end = static_cast<int>(tile_.size());
  while (work.part < work.end && tile_[work.part].mask == kAll) ++work.part;
  work_.push_back(work);
}

std::size_t HostStencil::Bytes() const {
  return 8 * (u_.size() + v_.size() + w_[0].size() + w_[1].size()) +
         4 * (plan_.node.size() + plan_.position.size() + plan_.list.size()) +
         sizeof(StencilEntry) * plan_.entry.size();
}

std::string HostStencil::Text() const { return StencilText(plan_); }

/// The first of some places whose velocity is no reasonable number.
void HostStencil::Blame(int step, int place, int mask, Failure *failure) const {
  for (int l = 0; failure->step < 0 && l < kLanes; ++l) {
    double size = 0;
    for (int k = 0; k < 3; ++k) size += std::fabs(v_[k * stride_ + place + l]);
    if ((mask >> l & 1) && !(size < 1e100)) *failure = Failure{step, plan_.node[place + l]};
  }
}

template <bool kBeta, int kTiles>
void HostStencil::Lanesful(const StencilClass &c, const Tile *tiles, const StepArgs &args, const double *now,
                           double *next, int step, Failure *failure) {
  constexpr bool kMasked = kTiles == 1;  // several have no other places between
  const std::ptrdiff_t stride = stride_;
  Lanes f[kTiles][3] = {};
  const StencilEntry *entry = &plan_.entry[c.first];
  for (int k = 0; k < c.count; ++k) CDEM_UNROLL for (int t = 0; t < kTiles; ++t) {
      const double *from = now + tiles[t].place + entry[k].offset;
      AddCoupling(entry[k].block, LoadAs<Lanes>(from), LoadAs<Lanes>(from + stride), LoadAs<Lanes>(from + 2 * stride),
                  f[t]);
    }
  CDEM_UNROLL for (int t = 0; t < kTiles; ++t) {
    const LaneMask mine = MaskOfBits(tiles[t].mask);
    Lanes u[3], v[3], size = {};
    auto store = [&](double *to, Lanes value) { StoreAs(to, kMasked ? (mine ? value : LoadAs<Lanes>(to)) : value); };
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      u[k] = LoadAs<Lanes>((kBeta ? u_.data() : now) + k * stride + tiles[t].place);
      v[k] = LoadAs<Lanes>(&v_[k * stride + tiles[t].place]);
    }
    MoveFree(args, c.inverse_mass, f[t], u, v);
    CDEM_UNROLL for (int k = 0; k < 3; ++k) {
      store(&v_[k * stride + tiles[t].place], v[k]);
      if (kBeta) store(&u_[k * stride + tiles[t].place], u[k]);
      store(next + k * stride + tiles[t].place, kBeta ? u[k] + beta_ * v[k] : u[k]);
      size += v[k] < 0 ? -v[k] : v[k];
    }
    if (Any(~(size < 1e100))) Blame(step, tiles[t].place, tiles[t].mask, failure);
  }
}

template <bool kBeta>
void HostStencil::One(const StencilClass &c, int position, const NodeView &nodes, const StepArgs &args, int step,
                      const double *now, double *next, Failure *failure) {
  const int place = plan_.position[position];
  if (place < 0) return;
  const int lane = (position - c.begin) % kPad;
  const int *list = c.list < 0
                        ? nullptr
                        : &plan_.list[c.list + static_cast<std::int64_t>(position - c.begin - lane) * c.count + lane];
  double f[3] = {0, 0, 0}, u[3], v[3];
  for (int k = 0; k < c.count; ++k) {
    const StencilEntry &entry = plan_.entry[c.first + k];
    const double *from = now + (list ? list[k * kPad] : place + entry.offset);
    AddCoupling(entry.block, from[0], from[stride_], from[2 * stride_], f);
  }
  for (int k = 0; k < 3; ++k) {
    u[k] = (kBeta ? u_.data() : now)[k * stride_ + place];
    v[k] = v_[k * stride_ + place];
  }
  if (c.records)
    MoveRecorded(nodes, args, nodes.record[plan_.node[place]], step, c.inverse_mass, f, u, v);
  else
    MoveFree(args, c.inverse_mass, f, u, v);
  for (int k = 0; k < 3; ++k) {
    v_[k * stride_ + place] = v[k];
    if (kBeta) u_[k * stride_ + place] = u[k];
    next[k * stride_ + place] = kBeta ? u[k] + beta_ * v[k] : u[k];
  }
  if (!(std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]) < 1e100)) Blame(step, place, 1, failure);
}

template <bool kBeta>
void HostStencil::Step(const NodeView &nodes, const StepArgs &args, int step, const double *now, double *next,
                       Failure *failure) {
  for (const Work &w : work_) {
    const StencilClass &c = plan_.classes[w.of];
    int t = w.full;
    for (; t + kTogether <= w.part; t += kTogether)
      Lanesful<kBeta, kTogether>(c, &tile_[t], args, now, next, step, failure);
    for (; t < w.end; ++t) Lanesful<kBeta, 1>(c, &tile_[t], args, now, next, step, failure);
    for (int p = w.one_begin; p < w.one_end; ++p) One<kBeta>(c, p, nodes, args, step, now, next, failure);
  }
}

void HostStencil::Run(const NodeView &nodes, const StepArgs &args, int first, int n, Failure *failure) {
  if (n == 0) return;
  const int places = static_cast<int>(plan_.node.size());
  for (int place = 0; place < places; ++place)
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = k * stride_ + place, from = 3 * static_cast<std::size_t>(plan_.node[place]) + k;
      v_[at] = nodes.v[from];
      if (beta_ != 0) u_[at] = nodes.u[from];
      w_[0][at] = w_[1][at] = beta_ != 0 ? nodes.u[from] + beta_ * nodes.v[from] : nodes.u[from];
    }
  int now = 0;
  for (int step = first; step < first + n && failure->step < 0; ++step, now = 1 - now)
    if (beta_ != 0)
      Step<true>(nodes, args, step, w_[now].data(), w_[1 - now].data(), failure);
    else
      Step<false>(nodes, args, step, w_[now].data(), w_[1 - now].data(), failure);
  const std::vector<double> &u = beta_ != 0 ? u_ : w_[now];
  for (int place = 0; place < places; ++place)
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = k * stride_ + place, to = 3 * static_cast<std::size_t>(plan_.node[place]) + k;
      nodes.u[to] = u[at];
      nodes.v[to] = v_[at];
    }
}

}  // namespace cdem
