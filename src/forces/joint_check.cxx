#include "forces/joint_check.hpp"

#include "core/error.hpp"
#include "forces/params.hpp"
#include "physics/laws.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem {

namespace {

/// Of one interface, over all faces. Kept as minima, so that one reduction serves.
struct FaceRange {
  double kn = kPropertyInf, ks = kPropertyInf;  ///< the softest face [Pa/m]
  double fineness = kPropertyInf;  ///< largest cell that resolves the failure / distance of the cell centres
};

void Widen(const Mesh &mesh, const std::vector<Material> &materials, const Joint &joint, const Face &face,
           const double *property, FaceRange *range) {
  const double young =
      std::min(materials[mesh.cell_region[face.cell[0]]].young(), materials[mesh.cell_region[face.cell[1]]].young());
  JointLaws::Visit(joint.law, [&](auto law) {
    range->fineness =
        std::min(range->fineness, decltype(law)::LargestCell(property, young) / CentreDistance(mesh, face));
  });
}

/// What is wrong with the own strength of a face whose springs have this stiffness per area, or "".
std::string WrongAt(const Joint &joint, const double *property, double kn, double ks) {
  std::string wrong;
  JointLaws::Visit(joint.law, [&](auto law) {
    wrong = decltype(law)::Check(property);
    if (wrong.empty()) wrong = decltype(law)::CheckFace(property, kn, ks);
  });
  return wrong;
}

}  // namespace

PetscErrorCode CheckJoints(const Mesh &mesh, const std::vector<std::string> &names,
                           const std::vector<Material> &materials, const std::vector<Joint> &joints,
                           const Tables &tables, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  static_assert(sizeof(FaceRange) == 3 * sizeof(double), "reduced as an array of doubles");
  std::vector<FaceRange> ranges(joints.size());
  std::string failure;
  for (const SpringTable &t : tables.springs)
    for (int i = 0; i < t.n; ++i) {
      const int id = t.interface[i];
      const Joint &joint = joints[id];
      FaceRange &range = ranges[id];
      range.kn = std::min(range.kn, t.kn[i] / t.area[i]);
      range.ks = std::min(range.ks, t.ks[i] / t.area[i]);
      if (i > 0 && t.face[i] == t.face[i - 1]) continue;
      double property[kMaxProperties];
      FaceProperties(mesh, joint, mesh.faces[t.face[i]], property);
      Widen(mesh, materials, joint, mesh.faces[t.face[i]], property, &range);
      if (!HasOwnParams(joint) || !failure.empty()) continue;
      failure = WrongAt(joint, property, t.kn[i] / t.area[i], t.ks[i] / t.area[i]);
      const char *why = joint.scatter.any ? "as its properties scatter" : "with the strengths of the blocks beside it";
      if (!failure.empty()) failure = "interface '" + names[id] + "', " + why + ": " + failure;
    }
  PetscCall(CheckFailure(mesh.comm, failure));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, ranges.data(), static_cast<int>(3 * ranges.size()), MPI_DOUBLE, MPI_MIN, mesh.comm));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const FaceRange &range = ranges[i];
    std::string wrong;
    if (!HasOwnParams(joints[i]))  // others were seen face by face
      JointLaws::Visit(joints[i].law,
                       [&](auto law) { wrong = decltype(law)::CheckFace(joints[i].property, range.kn, range.ks); });
    CdemCheck(wrong.empty(), mesh.comm, "interface '%s': %s", names[i].c_str(), wrong.c_str());
    if (range.fineness >= 1 - 1e-9) continue;
    char text[300];
    std::snprintf(text, sizeof text,
                  "interface %s: the cells beside it are up to %.3g times too large for its softening (h <= l_ch/5, "
                  "l_ch = E gi / tension^2): peak loads will depend on the mesh",
                  names[i].c_str(), 1 / range.fineness);
    remarks->push_back(text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
