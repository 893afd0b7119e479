#include "forces/element_fields.hpp"

#include "forces/bodies.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

namespace {

/// Instead of a law: adds up one number of the points' states, weighted by their volumes.
struct VolumeMean {
  const double *value;  ///< of the element's first point
  std::size_t stride;   ///< from point to point
  double *sum, *volume;

  void operator()(int g, const double *, double share, double *stress) const {
    *sum += share * value[g * stride];
    *volume += share;
    std::fill_n(stress, 6, 0.0);
  }
  void operator()(int g, const double *strain, double share, const double (*)[3], double *stress) const {
    (*this)(g, strain, share, stress);
  }
  double ShearModulus() const { return 0; }
  void Stored(double) const {}
};

template <class Form>
double Mean(const Tables &tables, const ElementTable &t, int e, const double *value, std::size_t stride) {
  double x[Form::kCorners][3], u[Form::kCorners][3] = {}, f[Form::kCorners][3], sum = 0, volume = 0;
  for (int a = 0; a < Form::kCorners; ++a)
    std::copy_n(&tables.x[3 * static_cast<std::size_t>(t.node[static_cast<std::size_t>(a) * t.n_pad + e])], 3, x[a]);
  Form::Forces(x, u, VolumeMean{value, stride, &sum, &volume}, f);
  return sum / volume;
}

}  // namespace

PetscErrorCode FindLawFields(const Tables &tables, LawFields *there) {
  PetscFunctionBeginUser;
  int has[3] = {there->plastic, there->broken, there->damage};
  for (const ElementTable &t : tables.elements) {
    BlockLaws::Visit(t.law, [&](auto law) { has[0] |= decltype(law)::kPlasticShear >= 0; });
    has[1] |= t.judged;
  }
  for (const SpringTable &t : tables.springs)
    JointLaws::Visit(t.law, [&](auto law) { has[2] |= decltype(law)::kDamage >= 0; });
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 3, MPI_INT, MPI_MAX, tables.comm));
  *there = {has[0] != 0, has[1] != 0, has[2] != 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

double DamageOf(const SpringTable &table, const SpringHistory &history, std::uint8_t state, int i) {
  if (state & kCohesionLost) return 1;
  double damage = 0;
  JointLaws::Visit(table.law, [&](auto law) {
    constexpr int number = decltype(law)::kDamage;
    if constexpr (number >= 0)
      if (history.state[i] != 0) damage = history.values[static_cast<std::size_t>(number) * table.n_pad + i];
  });
  return damage;
}

void FillElementFields(const Tables &tables, int n_owned_cells, const std::vector<ElementHistories> &history,
                       const LawFields &wanted, ElementFields *fields) {
  const std::size_t n = static_cast<std::size_t>(n_owned_cells);
  fields->plastic_strain.assign(wanted.plastic ? n : 0, 0.0);
  fields->broken.assign(wanted.broken ? n : 0, 0.0);
  fields->broken_time.assign(wanted.broken ? n : 0, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t g = 0; g < tables.elements.size(); ++g) {
    const ElementTable &t = tables.elements[g];
    const ElementHistories &h = history[g];
    VisitBlock(t.shape, t.form, t.law, [&](auto form, auto law) {
      using Form = decltype(form);
      using Law = decltype(law);
      for (int e = 0; e < t.n; ++e) {
        const int cell = t.cell[e];
        if (cell >= n_owned_cells) continue;
        if constexpr (Law::kPlasticShear >= 0) {
          const std::size_t pad = static_cast<std::size_t>(t.n_pad);
          if (h.state[e] & kTouched)
            fields->plastic_strain[cell] =
                Mean<Form>(tables, t, e, &h.value[Law::kPlasticShear * pad + e], Law::kState * pad);
        }
        if constexpr (Law::kJudgesMean) {
          fields->broken[cell] = h.state[e] & kBrokenTension ? 1 : h.state[e] & kBrokenShear ? 2 : 0;
          fields->broken_time[cell] = h.broken_time[e];
        }
      }
    });
  }
}

}  // namespace cdem
