#include "forces/form_check.hpp"

#include "core/error.hpp"
#include "physics/elements.hpp"

namespace cdem {

int FormNumber(Shape shape, const std::string &name) {
  int form = -1;
  VisitForms(shape, [&](auto forms) { form = decltype(forms)::Find(name); });
  return form;
}

/// The forms that a region may ask for.
template <class... Forms>
static std::string NamesOfForms(LawList<Forms...>) {
  std::string all;
  ((all += Forms::kAtCorners || Forms::kAffine ? "" : std::string(all.empty() ? "" : ", ") + Forms::kName), ...);
  return all;
}

PetscErrorCode CheckForms(const Mesh &mesh, const std::vector<Material> &materials, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  static const char *const names[kShapes] = {"tetrahedra", "wedges", "hexahedra"};
  std::vector<int> has(kShapes * materials.size(), 0);
  for (PetscInt c = 0; c < mesh.n_owned; ++c)
    has[kShapes * mesh.cell_region[c] + static_cast<int>(mesh.cell_shape[c])] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has.data(), static_cast<int>(has.size()), MPI_INT, MPI_MAX, mesh.comm));
  for (std::size_t r = 0; r < materials.size(); ++r)
    for (int s = 0; s < kShapes; ++s) {
      if (!has[kShapes * r + s]) continue;
      const Shape shape = static_cast<Shape>(s);
      const Material &m = materials[r];
      std::string forms, law;
      bool at_corners = false, fits = false;
      BlockLaws::Visit(m.law, [&](auto l) {
        law = decltype(l)::kName;
        at_corners = decltype(l)::kAtCorners;
      });
      VisitForms(shape, [&](auto list) { forms = NamesOfForms(list); });
      const int form = FormNumber(shape, m.element);
      CdemCheck(form >= 0 || !at_corners, mesh.comm,
                "region '%s' has %s, for which there is no law %s: it is one of hexahedra", mesh.regions[r].c_str(),
                names[s], law.c_str());
      CdemCheck(form >= 0, mesh.comm, "region '%s' has %s, which know no element form '%s'; their forms are: %s",
                mesh.regions[r].c_str(), names[s], m.element.c_str(), forms.c_str());
      VisitBlock(shape, form, m.law, [&](auto, auto) { fits = true; });
      CdemCheck(fits, mesh.comm, "region '%s': the law %s cannot be computed in %s of form '%s'",
                mesh.regions[r].c_str(), law.c_str(), names[s], m.element.c_str());
      bool plastic = false;
      BlockLaws::Visit(m.law, [&](auto l) { plastic = decltype(l)::kPlasticShear >= 0; });
      if (shape == Shape::kTet && m.element == "full" && plastic)
        remarks->push_back(
            "region " + mesh.regions[r] +
            ": tetrahedra of form full lock in plastic flow: strengths come out too high; element bbar is made for it");
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
