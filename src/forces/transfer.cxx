#include "forces/references.hpp"

#include "forces/bodies.hpp"
#include "forces/dilatation.hpp"

#include <algorithm>
#include <unordered_map>

namespace cdem {

namespace {

struct Place {
  int table = -1, row = -1;
};

/// Where every local cell stands in the element tables.
std::vector<Place> PlacesOfCells(const Tables &tables) {
  std::vector<Place> places(tables.n_cells);
  for (std::size_t g = 0; g < tables.elements.size(); ++g)
    for (int e = 0; e < tables.elements[g].n; ++e) places[tables.elements[g].cell[e]] = {static_cast<int>(g), e};
  return places;
}

/// The first spring of every face.
std::unordered_map<int, Place> PlacesOfFaces(const Tables &tables) {
  std::unordered_map<int, Place> places;
  for (std::size_t g = 0; g < tables.springs.size(); ++g)
    for (int i = 0; i < tables.springs[g].n; ++i)
      places.emplace(tables.springs[g].face[i], Place{static_cast<int>(g), i});
  return places;
}

/// The spring of the same nodes, or a row of -1.
Place FindSpring(const Tables &tables, const std::unordered_map<int, Place> &places, const SpringTable &t, int i) {
  const auto at = places.find(t.face[i]);
  if (at == places.end()) return {};
  const SpringTable &from = tables.springs[at->second.table];
  for (int j = at->second.row; j < from.n && from.face[j] == t.face[i]; ++j)
    if (from.a[j] == t.a[i] && from.b[j] == t.b[i]) return {at->second.table, j};
  return {};
}

/// Copies n numbers with the strides of their tables.
void CopyNumbers(const double *from, int from_stride, double *to, int to_stride, int n) {
  for (int k = 0; k < n; ++k)
    to[static_cast<std::size_t>(k) * to_stride] = from[static_cast<std::size_t>(k) * from_stride];
}

/// A point that also keeps what it is given and gives: strain - the strain of its stress with other moduli.
template <class Law>
struct KeepingPoint {
  PointOf<Law, true, double> point;
  const double *other;  ///< parameters
  double (*offset)[6];  ///< [out] per point

  void operator()(int g, const double strain[6], double volume, double stress[6]) const {
    point(g, strain, volume, stress);
    StrainOfStress(other, stress, offset[g]);
    for (int i = 0; i < 6; ++i) offset[g][i] = strain[i] - offset[g][i];
  }
  double ShearModulus() const { return point.ShearModulus(); }
  void Stored(double) const {}
};

/// The offsets with which an element has its present stress under other moduli.
template <class Form, class Law>
void PresentOffsets(const Tables &old, const ElementTable &t, const ElementHistories &before, int e, const double *u,
                    const double *of_node, const double *other, double (*offset)[6]) {
  double x[Form::kCorners][3], w[Form::kCorners][3], f[Form::kCorners][3];
  for (int a = 0; a < Form::kCorners; ++a) {
    const std::size_t at = 3 * static_cast<std::size_t>(t.Node(a, e));
    std::copy_n(&old.x[at], 3, x[a]);
    std::copy_n(&u[at], 3, w[a]);
  }
  if constexpr (Form::kAverages) TetBbar::Spread(x, of_node, w);
  const double *param = &old.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
  ElementSums<double> sums = {};
  ElementHistory<double> history;
  history.stride = t.n_pad;
  history.changed = history.touched = history.tension = history.shear = false;
  if constexpr (Law::kState > 0) {
    history.value = const_cast<double *>(&before.value[e]);  // an observation only reads
    history.touched = (before.state[e] & kTouched) != 0;
    history.tension = (before.state[e] & kBrokenTension) != 0;
    history.shear = (before.state[e] & kBrokenShear) != 0;
  }
  if constexpr (Law::kJudgesMean) {
    if (!history.tension && !history.shear) {  // the residual strength is not for intact elements
      using Intact = ElasticFrom<Law::kState>;
      ElementHistory<double> from = history;
      from.touched = Law::kCarriesOffset && history.touched;
      Form::Forces(x, w, KeepingPoint<Intact>{{param, &sums, &from}, other, offset}, f);
      return;
    }
  }
  Form::Forces(x, w, KeepingPoint<Law>{{param, &sums, &history}, other, offset}, f);
}

/// What an element takes along into a law that carries an offset.
template <class Form, class Law>
void TakeElement(const Tables &old, const ElementTable &from, const ElementHistories &before, int row, const double *u,
                 const Averages &averages, const Tables &tables, const ElementTable &t, int e, ElementHistories *h) {
  const double *param = &tables.block_param[static_cast<std::size_t>(kMaxParams) * t.material[e]];
  const double *was = &old.block_param[static_cast<std::size_t>(kMaxParams) * from.material[row]];
  double offset[Form::kPoints][6] = {}, of_node[4] = {};
  bool carried = false;
  BlockLaws::Visit(from.law, [&](auto law) {
    using Old = decltype(law);
    if constexpr (kFits<Form, Old> && Old::kState > 0)
      if (Old::kCarriesOffset || before.state[row] & (kBrokenTension | kBrokenShear))
        carried = before.state[row] & kTouched;
    if constexpr (kFits<Form, Old>) {
      if (param[0] == was[0] && param[1] == was[1]) {  // to the last bit
        if constexpr (Old::kState > 0)
          for (int g = 0; carried && g < Form::kPoints; ++g)
            for (int i = 0; i < 6; ++i)
              offset[g][i] = before.value[static_cast<std::size_t>(g * Old::kState + i) * from.n_pad + row];
      } else if constexpr (!Form::kAtCorners) {  // the others cannot change their stiffness
        if constexpr (Form::kAverages)
          for (int a = 0; a < 4; ++a) of_node[a] = averages.dilatation[from.Layered(old.layers, a, row)];
        PresentOffsets<Form, Old>(old, from, before, row, u, of_node, param, offset);
        carried = true;
      }
    }
  });
  if (!carried) return;
  for (int g = 0; g < Form::kPoints; ++g)
    for (int i = 0; i < 6; ++i) h->value[static_cast<std::size_t>(g * Law::kState + i) * t.n_pad + e] = offset[g][i];
  h->state[e] |= kTouched;
}

/// The force on b of a spring, as an observation sees it: F_n n + F_s [N], with its history.
template <class Law>
void PresentForce(const Tables &old, const SpringTable &t, const SpringHistory &before, int i, const double *u,
                  Spring<double> *s, double force[3]) {
  for (int k = 0; k < 3; ++k) {
    s->normal[k] = t.normal[static_cast<std::size_t>(k) * t.n_pad + i];
    s->d[k] = u[3 * static_cast<std::size_t>(t.b[i]) + k] - u[3 * static_cast<std::size_t>(t.a[i]) + k];
    s->beta_rate[k] = 0;
  }
  s->kn = t.kn[i], s->ks = t.ks[i], s->area = t.area[i];
  s->param = &old.joint_param[static_cast<std::size_t>(kMaxParams) * t.joint[i]];
  s->tension_lost = s->cohesion_lost = 0;
  if constexpr (Law::kHistory) {
    s->tension_lost = before.state[i] & kTensionLost ? 1 : 0;
    s->cohesion_lost = before.state[i] & kCohesionLost ? 1 : 0;
    for (int k = 0; k < Law::kState; ++k) s->history[k] = before.values[static_cast<std::size_t>(k) * t.n_pad + i];
  }
  SpringForce<Law, false>(*s, force);
}

/// What a spring takes along into a law that carries an offset: of an open crack its opening stays, of others the force.
template <class Law>
void TakeSpring(const Tables &old, const SpringTable &from, const SpringHistory &before, int row, const double *u,
                const SpringTable &t, int i, SpringHistory *h) {
  auto number = [&](int n) -> double & { return h->values[static_cast<std::size_t>(n) * t.n_pad + i]; };
  if (!from.state.empty()) h->state[i] = before.state[row];
  if (from.law == t.law) CopyNumbers(&before.values[row], from.n_pad, &number(0), t.n_pad, t.n_state);
  if (from.law == t.law && from.kn[row] == t.kn[i] && from.ks[row] == t.ks[i]) return;  // to the last bit
  JointLaws::Visit(from.law, [&](auto law) {
    Spring<double> s;
    double force[3];
    PresentForce<decltype(law)>(old, from, before, row, u, &s, force);
    const double along = Dot(s.normal, force), apart = Dot(s.normal, s.d);
    const bool open = !from.state.empty() && (before.state[row] & kOpen);
    if (!open) number(Law::kGap) = apart + along / t.kn[i];
    for (int k = 0; k < 3; ++k)
      number(Law::kSlip + k) = s.d[k] - apart * s.normal[k] + (force[k] - along * s.normal[k]) / t.ks[i];
    h->state[i] |= kDamaged;
  });
}

}  // namespace

PetscErrorCode TransferHistories(const Mesh &, const Tables &old, const Histories &before, const Tables &tables,
                                 const double *u, Histories *after) {
  PetscFunctionBeginUser;
  after->elements = StartElements(tables);
  after->springs = StartSprings(tables);
  Averages averages;
  if (old.layers > 0) PetscCall(AverageDilatation(old, u, u, 0, &averages));
  const std::vector<Place> cells = PlacesOfCells(old);
  for (std::size_t g = 0; g < tables.elements.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    ElementHistories &h = after->elements[g];
    for (int e = 0; e < t.n && t.states > 0; ++e) {
      const Place at = cells[t.cell[e]];
      const ElementTable &from = old.elements[at.table];
      const ElementHistories &b = before.elements[at.table];
      if (from.law == t.law && from.form == t.form) {
        h.state[e] = b.state[at.row];
        CopyNumbers(&b.value[at.row], from.n_pad, &h.value[e], t.n_pad, t.states);
        if (t.judged) h.broken_time[e] = b.broken_time[at.row];
      } else if (from.judged && t.judged) {
        h.state[e] = b.state[at.row];
        h.broken_time[e] = b.broken_time[at.row];
      }
      VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
        if constexpr (decltype(law)::kCarriesOffset)
          TakeElement<decltype(form), decltype(law)>(old, from, b, at.row, u, averages, tables, t, e, &h);
      });
    }
  }
  const std::unordered_map<int, Place> faces = PlacesOfFaces(old);
  for (std::size_t g = 0; g < tables.springs.size(); ++g) {
    const SpringTable &t = tables.springs[g];
    SpringHistory &h = after->springs[g];
    for (int i = 0; i < t.n && !t.state.empty(); ++i) {
      const Place at = FindSpring(old, faces, t, i);
      if (at.row < 0) continue;
      const SpringTable &from = old.springs[at.table];
      const SpringHistory &b = before.springs[at.table];
      bool carries = false;
      JointLaws::Visit(t.law, [&](auto law) {
        carries = decltype(law)::kCarriesOffset;
        if constexpr (decltype(law)::kCarriesOffset) TakeSpring<decltype(law)>(old, from, b, at.row, u, t, i, &h);
      });
      if (carries || from.law != t.law) continue;
      h.state[i] = b.state[at.row];
      CopyNumbers(&b.values[at.row], from.n_pad, &h.values[i], t.n_pad, t.n_state);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
