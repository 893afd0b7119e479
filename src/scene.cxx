#include "scene.hpp"

#include "core/error.hpp"
#include "loads/quiet.hpp"
#include "mesh/interfaces.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

/// What holds for this stage alone, and the regions that leave.
static PetscErrorCode ReadStage(Options &options, const Mesh &mesh, Scene *scene) {
  PetscFunctionBeginUser;
  const std::string &name = scene->name;
  std::vector<std::string> regions;
  PetscCall(options.Names({"stage", name, "remove"}, &regions, &scene->removes));
  for (const std::string &region : regions) {
    const int r = Mesh::Find(mesh.regions, region);
    CdemCheck(r >= 0, mesh.comm, "-stage_%s_remove: the mesh has no region '%s'; regions: %s", name.c_str(),
              region.c_str(), Joined(mesh.regions).c_str());
    CdemCheck(!scene->removed[r], mesh.comm, "-stage_%s_remove: region '%s' has left in an earlier stage", name.c_str(),
              region.c_str());
    scene->removed[r] = 1;
  }
  const bool all = std::all_of(scene->removed.begin(), scene->removed.end(), [](char gone) { return gone != 0; });
  CdemCheck(!all, mesh.comm, "-stage_%s_remove: nothing would be left of the body", name.c_str());
  std::string origin;
  PetscCall(options.Word({"stage", name, "reset"}, &origin, &scene->reset));
  PetscCall(options.Flag({"stage", name, "intact"}, &scene->intact));
  bool set;
  PetscCall(options.Real({"stage", name, "strength_factor"}, &scene->strength_factor, &set));
  CdemCheck(scene->strength_factor > 0, mesh.comm, "-stage_%s_strength_factor is %g; it must be above 0", name.c_str(),
            scene->strength_factor);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// -ts_dt, -ts_max_time and -ts_max_steps belong to TS; they are read here because the default step depends on them.
static PetscErrorCode ReadTime(Options &options, Scene *scene) {
  PetscFunctionBeginUser;
  PetscCall(options.Word("ts_central_check", &scene->check));
  PetscCall(options.Word("ts_central_limit", &scene->limit));
  PetscCall(options.Real("ts_central_safety", &scene->safety));
  CdemCheck(scene->safety > 0 && scene->safety <= 1, options.comm(),
            "-ts_central_safety is %g; it must be above 0 and at most 1", scene->safety);
  PetscCall(options.Real("ts_dt", &scene->dt, &scene->dt_given));
  CdemCheck(!scene->dt_given || (scene->dt > 0 && std::isfinite(scene->dt)), options.comm(),
            "-ts_dt is %g; it must be above 0", scene->dt);
  PetscCall(options.Real("ts_max_time", &scene->end_time, &scene->has_end_time));
  PetscCall(options.Int("ts_max_steps", &scene->end_step, &scene->has_end_step));
  CdemCheck(!scene->has_end_time || (scene->end_time > 0 && std::isfinite(scene->end_time)), options.comm(),
            "-ts_max_time is %g; it must be above 0", scene->end_time);
  CdemCheck(!scene->has_end_step || scene->end_step >= 0, options.comm(),
            "-ts_max_steps is %lld; it must be at least 0", static_cast<long long>(scene->end_step));
  if (scene->relax) {
    PetscCall(ReadRelaxPlan(options, &scene->relaxation));
  } else {
    CdemCheck(scene->has_end_time || scene->has_end_step, options.comm(),
              "how long to run%s%s? Give -ts_max_time in s, or -ts_max_steps, or both",
              scene->name.empty() ? "" : " stage ", scene->name.c_str());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadScene(Options &options, const Mesh &mesh, const std::vector<std::string> &interfaces,
                                const std::vector<std::vector<RegionPair>> &sides, Scene *scene,
                                std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  std::string solve = "dynamic";
  PetscCall(options.Word("solve", &solve));
  scene->relax = solve == "relax";
  if (!scene->name.empty()) PetscCall(ReadStage(options, mesh, scene));
  const StrengthChange change{scene->strength_factor, scene->intact};
  PetscCall(ReadMaterials(options, mesh.regions, change, &scene->materials, remarks));
  PetscCall(ReadJoints(options, interfaces, {mesh.regions, scene->materials, sides}, change, &scene->joints, remarks));
  PetscCall(ReadTables(options, &scene->table_names, &scene->tables));
  PetscCall(ReadBoundaries(mesh, options, scene->table_names, &scene->boundaries));
  PetscCall(options.Reals("gravity", 3, scene->gravity));
  const std::pair<const char *, double *> damping[] = {
      {"damping_alpha", &scene->alpha}, {"damping_beta", &scene->beta}, {"damping_local", &scene->local}};
  for (const auto &[key, value] : damping) {
    PetscCall(options.Real(key, value));
    CdemCheck(*value >= 0, mesh.comm, "-%s is %g; it must be at least 0", key, *value);
  }
  CdemCheck(scene->local < 1, mesh.comm, "-damping_local is %g; it must be below 1", scene->local);
  PetscCall(ReadTime(options, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Whether an interface's springs are other ones (elastically) than before.
static bool IsOther(const Joint &joint, const Joint &before) {
  return joint.law != before.law || joint.kn != before.kn || joint.ks != before.ks ||
         joint.stiffness_factor != before.stiffness_factor;
}

/// Gives the laws that carry an offset to what is under stress from the start or changes its stiffness, from then on.
static PetscErrorCode CarryOffsets(const Mesh &mesh, std::vector<Scene> *scenes) {
  PetscFunctionBeginUser;
  const std::vector<Scene> plain = *scenes;  // laws as they were asked for
  bool stressed = false, springs = false;
  for (const Material &m : plain[0].materials) stressed = stressed || m.stressed;
  std::vector<char> other(plain[0].materials.size(), 0);
  for (std::size_t k = 0; k < scenes->size(); ++k) {
    Scene &scene = (*scenes)[k];
    for (std::size_t r = 0; r < other.size(); ++r) {
      Material &m = scene.materials[r];
      const Material &before = plain[k > 0 ? k - 1 : 0].materials[r];
      CdemCheck(
          std::equal(m.stress, m.stress + 6, before.stress) && std::equal(m.gradient, m.gradient + 6, before.gradient),
          mesh.comm, "stage '%s' changes the stress of region '%s' that is there from the start: take it out",
          scene.name.c_str(), mesh.regions[r].c_str());
      CdemCheck(m.element == before.element || m.law != before.law, mesh.comm,
                "stage '%s' changes the element form of region '%s': its history would be lost; take it out",
                scene.name.c_str(), mesh.regions[r].c_str());
      if (m.law != before.law || m.property[0] != before.property[0] || m.property[1] != before.property[1])
        other[r] = 1;
      m.restiffened = other[r];
      if (m.stressed || m.restiffened) PetscCall(CarryOffset(mesh.comm, mesh.regions[r], &m));
      springs = springs || other[r];
    }
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
      springs = springs || IsOther(scene.joints[i], plain[k > 0 ? k - 1 : 0].joints[i]);
    if (stressed || springs)
      for (Joint &joint : scene.joints) {
        CarryOffset(&joint);
        CdemCheck(joint.law >= 0, mesh.comm,
                  "interfaces beside stress from the start, or of a stiffness that changes in a stage: this cdem was "
                  "built with the elastic laws alone (CDEM_ELASTIC_ONLY), which cannot");
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadScenes(Options &options, const Mesh &mesh, const std::vector<std::string> &interfaces,
                          const std::vector<int> &face_interface, std::vector<Scene> *scenes,
                          std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  std::vector<std::string> names, said;
  bool staged;
  PetscCall(options.Names("stages", &names, &staged));
  options.Declare("stage", names);
  if (names.empty()) names = {""};
  std::vector<std::vector<RegionPair>> sides;
  PetscCall(FindSides(mesh, face_interface, interfaces.size(), &sides));
  Scene before;
  before.removed.assign(mesh.regions.size(), 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    Scene scene;
    scene.name = names[i];
    scene.removed = before.removed;
    scene.strength_factor = before.strength_factor;
    if (staged) options.SetStages({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i) + 1});
    PetscCall(ReadScene(options, mesh, interfaces, sides, &scene, &said));
    const auto drops = [](const Boundary &b) { return b.lets_go && !b.keeps_reactions; };
    if (i == 0 || std::any_of(scene.boundaries.begin(), scene.boundaries.end(), drops))
      RemarkUnheldWeight(scene.boundaries, scene.gravity, &said);
    scenes->push_back(scene);
    before = scene;
  }
  options.SetStages({});
  bool ends = false, all_relax = true;
  for (const Scene &scene : *scenes) {
    ends = ends || scene.has_end_time || scene.has_end_step;
    all_relax = all_relax && scene.relax;
  }
  CdemCheck(!ends || !all_relax, mesh.comm,
            "%s: take out -ts_max_time and -ts_max_steps; -relax_max_steps limits the steps",
            staged ? "every stage relaxes, and ends when the body is in balance"
                   : "-solve relax ends when the body is in balance");
  PetscCall(CarryOffsets(mesh, scenes));
  for (const std::string &remark : said)
    if (std::find(remarks->begin(), remarks->end(), remark) == remarks->end()) remarks->push_back(remark);
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
