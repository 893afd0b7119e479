#include "forces/bound_parts.hpp"
#include "forces/step_bound.hpp"

#include <unordered_map>

namespace cdem {

/// The bound of every element of a table [1/s^2]; congruent ones are looked at once.
template <class Form>
static std::vector<double> EachBound(const Tables &tables, const ElementTable &t,
                                     const std::vector<Material> &materials) {
  std::unordered_map<std::uint64_t, int> classes;
  std::vector<int> of_element(t.n);
  std::vector<Canonical> kind;
  for (int e = 0; e < t.n; ++e) {
    Canonical c;
    MakeCanonical(tables, t, materials, e, &c);
    const auto [at, fresh] = classes.emplace(Hash(c, t.corners), static_cast<int>(kind.size()));
    if (fresh) kind.push_back(c);
    of_element[e] = at->second;
  }
  std::vector<double> bound(Padded(static_cast<int>(kind.size()))), each(t.n);
  kind.resize(bound.size(), kind.back());
  for (std::size_t i = 0; i < bound.size(); i += kLanes) {
    const Lanes w2 = LanesBound<Form>(&kind[i]);
    for (int l = 0; l < kLanes; ++l) bound[i + l] = w2[l];
  }
  for (int e = 0; e < t.n; ++e) each[e] = bound[of_element[e]];
  return each;
}

void ScaleMasses(const std::vector<Material> &materials, double w2, Tables *tables) {
  std::vector<double> scaled(tables->n_owned, 0.0);
  for (const ElementTable &t : tables->elements)
    VisitElement(t.shape, t.form, [&](auto form) {
      const std::vector<double> each = EachBound<decltype(form)>(*tables, t, materials);
      for (int e = 0; e < t.n; ++e) {
        double x[kMaxCorners][3], volume[kMaxCorners];
        for (int a = 0; a < t.corners; ++a)
          std::copy_n(&tables->x[3 * static_cast<std::size_t>(t.Node(a, e))], 3, x[a]);
        CornerVolumes(t.shape, x, volume);
        for (int a = 0; a < t.corners; ++a)
          if (t.Node(a, e) < tables->n_owned)
            scaled[t.Node(a, e)] += each[e] / w2 * materials[t.region[e]].density * volume[a];
      }
    });
  if (!tables->springs.empty()) {
    const std::vector<std::array<double, 6>> sum = SpringStiffness(*tables);
    for (int i = 0; i < tables->n_owned; ++i) scaled[i] += 2 * LargestEigenvalue(sum[i]) / w2;
  }
  tables->weight.assign(tables->n_owned, 0.0);
  for (int i = 0; i < tables->n_owned; ++i) {
    if (tables->mass[i] == 0) continue;
    tables->weight[i] = tables->mass[i] / scaled[i];
    tables->mass[i] = scaled[i];
    tables->inverse_mass[i] = 1 / scaled[i];
  }
}

}  // namespace cdem
