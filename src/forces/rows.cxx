#include "forces/rows.hpp"

#include "forces/bodies.hpp"

#include <algorithm>
#include <utility>

namespace cdem {

std::string NoRows(const Tables &t) {
  if (t.halo) return "several ranks";
  if (t.damped || !t.records.quiet.empty()) return "damping of nodes";
  for (const ElementTable &e : t.elements) {
    bool linear = false;
    VisitBlock(e.shape, e.form, e.law, [&](auto, auto law) { linear = decltype(law)::kLinear; });
    if (!linear || e.averages) return "blocks that are not linear, or average";
  }
  for (const SpringTable &s : t.springs) {
    bool linear = false;
    JointLaws::Visit(s.law, [&](auto law) { linear = decltype(law)::kLinear; });
    if (!linear) return "interfaces that are not linear";
  }
  return "";
}

namespace {

/// Cuts nodes [begin, end) into parts of nearly equal size, each time across the longest extent.
void Cut(const std::vector<double> &x, std::vector<int>::iterator begin, std::vector<int>::iterator end, int first,
         int parts, std::vector<int> *part) {
  if (parts == 1) {
    for (auto i = begin; i != end; ++i) (*part)[*i] = first;
    return;
  }
  int axis = 0;
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    auto less = [&](int a, int b) { return x[3 * a + k] < x[3 * b + k]; };
    const auto [low, high] = std::minmax_element(begin, end, less);
    const double extent = begin == end ? 0 : x[3 * *high + k] - x[3 * *low + k];
    if (extent > longest) axis = k, longest = extent;
  }
  const int half = parts / 2;
  const auto middle = begin + (end - begin) * half / parts;
  // ties go by the other coordinates, then by number: whole layers and rows stay together
  std::nth_element(begin, middle, end, [&](int a, int b) {
    for (int k = 0; k < 3; ++k) {
      const double p = x[3 * a + (axis + k) % 3], q = x[3 * b + (axis + k) % 3];
      if (p != q) return p < q;
    }
    return a < b;
  });
  Cut(x, begin, middle, first, half, part);
  Cut(x, middle, end, first + half, parts - half, part);
}

/// A coupling of a node: the slot that it reads, and its block of the stiffness.
struct Coupling {
  int slot;
  const double *block;
};

constexpr int kBanks = 16;  ///< of 8 bytes: sixteen lanes read at once what lies in different ones

/// Deals the couplings of four nodes, which stand side by side in sixteen threads, to their lanes, so that what the sixteen
/// read together lies in as many banks as can be. [in] slots: that a lane with nothing to do may read.
void Deal(std::vector<Coupling> *of, int block, std::size_t thread, int slots, RowPlan *plan) {
  using P = RowPlan;
  const std::size_t threads = plan->threads;
  for (int s = 0; s < P::kCouplings; ++s) {
    int busy[kBanks] = {};
    std::vector<char> read(P::kSlots, 0);
    for (int node = 0; node < kBanks / P::kLanes; ++node)
      for (int lane = 0; lane < P::kLanes; ++lane) {
        std::vector<Coupling> &left = of[node];
        int there[kBanks] = {};
        for (const Coupling &c : left) ++there[c.slot % kBanks];
        // what another lane reads too, which costs nothing; then the bank that is least busy, and of these the one that the
        // node has most to read from
        auto rank = [&](const Coupling &c) {
          return std::make_pair(read[c.slot] ? -1 : busy[c.slot % kBanks], -there[c.slot % kBanks]);
        };
        auto best = std::min_element(left.begin(), left.end(),
                                     [&](const Coupling &p, const Coupling &q) { return rank(p) < rank(q); });
        const std::size_t at = thread + P::kLanes * node + lane;
        int slot = static_cast<int>(std::min_element(busy, busy + slots) - busy);
        if (best != left.end()) {
          slot = best->slot;
          for (int m = 0; m < 9; ++m)
            plan->coefficient[(static_cast<std::size_t>(block) * P::kCouplings * 9 + 9 * s + m) * threads + at] =
                best->block[m];
          left.erase(best);
        }
        plan->slot[(static_cast<std::size_t>(block) * P::kCouplings + s) * threads + at] =
            static_cast<unsigned short>(slot);
        busy[slot % kBanks] += !read[slot];
        read[slot] = 1;
      }
  }
}

}  // namespace

std::vector<char> StillNodes(const Tables &t) {
  std::vector<char> still(t.n_owned, 0);
  for (int i = 0; i < t.n_owned && t.records.n > 0; ++i) {
    const int row = t.records.of_node[i];
    still[i] = row >= 0 && t.records.watch[row] < 0;
    for (int k = 0; k < 3 && still[i]; ++k)
      still[i] = (t.records.kind[row] >> (2 * k) & 3) == kVelocity && t.records.value[3 * row + k] == 0;
  }
  return still;
}

std::string PlanRows(const StiffnessRows &rows, const std::vector<double> &x, const std::vector<char> &still,
                     int max_blocks, RowPlan *plan) {
  using P = RowPlan;
  const int n = static_cast<int>(rows.start.size()) - 1;
  std::vector<int> order, part(n, -1), slot(n, -1);
  for (int i = 0; i < n; ++i) {
    if (!still[i]) order.push_back(i);
    if (rows.start[i + 1] - rows.start[i] > P::kLanes * P::kCouplings)
      return "a node coupled with more than " + std::to_string(P::kLanes * P::kCouplings) + " nodes";
  }
  const int moving = static_cast<int>(order.size());
  if (moving == 0) return "nothing that moves";
  if (moving > max_blocks * P::kNodes)
    return "more than " + std::to_string(max_blocks * P::kNodes) + " nodes that move";
  // few nodes want few blocks: one warp, of 8 nodes, for each of a block's four schedulers is enough
  for (plan->n_blocks = 1; 2 * plan->n_blocks <= max_blocks && 32 * plan->n_blocks < moving;) plan->n_blocks *= 2;
  Cut(x, order.begin(), order.end(), 0, plan->n_blocks, &part);
  std::vector<std::vector<int>> own(plan->n_blocks), halo(plan->n_blocks), fixed(plan->n_blocks);
  std::vector<char> sent(n, 0);
  for (int i = 0; i < n; ++i)
    for (int k = rows.start[i]; part[i] >= 0 && k < rows.start[i + 1]; ++k) {
      const int c = rows.column[k];
      if (part[c] == part[i]) continue;
      (part[c] < 0 ? fixed : halo)[part[i]].push_back(c);
      sent[i] |= part[c] >= 0;  // the couplings are mutual
    }
  for (char first : {1, 0})
    for (int i = 0; i < n; ++i)
      if (part[i] >= 0 && sent[i] == first) {
        slot[i] = static_cast<int>(own[part[i]].size());
        own[part[i]].push_back(i);
      }
  plan->far_start = {0};
  std::size_t most = 0;
  for (int b = 0; b < plan->n_blocks; ++b) {
    std::size_t slots = own[b].size();
    for (std::vector<int> *list : {&halo[b], &fixed[b]}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
      plan->far.insert(plan->far.end(), list->begin(), list->end());
      slots += list->size();
    }
    plan->own.push_back(static_cast<int>(own[b].size()));
    plan->halo.push_back(static_cast<int>(halo[b].size()));
    plan->far_start.push_back(static_cast<int>(plan->far.size()));
    most = std::max(most, own[b].size());
    if (slots > P::kSlots) return "a cut whose blocks read more than " + std::to_string(P::kSlots) + " nodes";
  }
  plan->threads = (static_cast<int>(most) * P::kLanes + 31) / 32 * 32;
  const std::size_t threads = plan->threads, all = plan->n_blocks * threads;
  plan->node.assign(all, -1);
  plan->coefficient.assign(all * P::kCouplings * 9, 0.0);
  plan->slot.assign(all * P::kCouplings, 0);
  plan->target.assign(static_cast<std::size_t>(plan->n_blocks) * P::kTargets * P::kNodes, -1);
  std::vector<std::vector<int>> targets(n);
  for (int b = 0; b < plan->n_blocks; ++b)
    for (std::size_t h = 0; h < halo[b].size(); ++h)
      targets[halo[b][h]].push_back(b << 16 | static_cast<int>(own[b].size() + h));
  for (int b = 0; b < plan->n_blocks; ++b) {
    auto place = [&](int c) {  // of a node among the slots
      if (part[c] == b) return static_cast<std::size_t>(slot[c]);
      const std::vector<int> &list = part[c] < 0 ? fixed[b] : halo[b];
      const std::size_t at = std::lower_bound(list.begin(), list.end(), c) - list.begin();
      return own[b].size() + (part[c] < 0 ? halo[b].size() : 0) + at;
    };
    std::vector<std::vector<Coupling>> couplings(threads / P::kLanes);
    for (std::size_t i = 0; i < own[b].size(); ++i) {
      const int node = own[b][i];
      for (int k = rows.start[node]; k < rows.start[node + 1]; ++k) {
        const int c = rows.column[k];
        couplings[i].push_back({static_cast<int>(place(c)), &rows.block[9 * static_cast<std::size_t>(k)]});
      }
      for (int l = 0; l < P::kLanes; ++l) plan->node[b * threads + P::kLanes * i + l] = node;
      if (targets[node].size() > P::kTargets)
        return "a node that more than " + std::to_string(P::kTargets) + " blocks of the cut share";
      for (std::size_t k = 0; k < targets[node].size(); ++k)
        plan->target[(static_cast<std::size_t>(b) * P::kNodes + i) * P::kTargets + k] = targets[node][k];
    }
    for (std::size_t i = 0; i < couplings.size(); i += kBanks / P::kLanes)
      Deal(&couplings[i], b, P::kLanes * i, std::min(kBanks, plan->own[b]), plan);
  }
  return "";
}

}  // namespace cdem
