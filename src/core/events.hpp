// Log events and stages of -log_view, all in one place.
#pragma once
#include "core/petsc.hpp"

namespace cdem {

struct Events {
  PetscLogEvent mesh, split, tables, bound, halo, elements, springs, nodes, batch, observe, frame;
  PetscLogStage setup, solve;
};
extern Events events;

/// Registers them; call once after PetscInitialize.
PetscErrorCode RegisterEvents();

}  // namespace cdem
