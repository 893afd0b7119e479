#include "core/events.hpp"

#include <utility>

namespace cdem {

Events events;

PetscErrorCode RegisterEvents() {
  PetscFunctionBeginUser;
  PetscClassId id;
  PetscCall(PetscClassIdRegister("cdem", &id));
  const std::pair<const char *, PetscLogEvent *> all[] = {
      {"CdemMesh", &events.mesh},       {"CdemSplit", &events.split}, {"CdemTables", &events.tables},
      {"CdemStepBound", &events.bound}, {"CdemHalo", &events.halo},   {"CdemElements", &events.elements},
      {"CdemSprings", &events.springs}, {"CdemNodes", &events.nodes}, {"CdemBatch", &events.batch},
      {"CdemObserve", &events.observe}, {"CdemFrame", &events.frame}};
  for (const auto &[name, event] : all) PetscCall(PetscLogEventRegister(name, id, event));
  PetscCall(PetscLogStageRegister("Set-up", &events.setup));
  PetscCall(PetscLogStageRegister("Solve", &events.solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
