// What stays where a support leaves: a boundary that a later stage makes quiet lets go of what it fixed, and the reactions
// that were there go on as constant forces.
#pragma once
#include "loads/boundary.hpp"

namespace cdem {

/// Finds out what a quiet boundary was before: where an earlier stage holds it, by what is given before it is made quiet,
/// that lets go, and -boundary_<name>_release says what becomes of the reactions. [out] wave: its velocity is given with it
/// or later, and so is that of a wave.
PetscErrorCode ReadRelease(Options &options, Boundary *b, bool *wave);

/// Whether some boundary becomes quiet between two stages and keeps its reactions.
bool KeepsReactions(const std::vector<Boundary> &before, const std::vector<Boundary> &now);

/// Forces that are held from the coming stage on (collective): of components that boundaries let go and keep, the reactions;
/// of those that are prescribed, none; of others what was held before. Where a relaxation has ended, what it has left out of
/// balance along a direction in which nothing is held any more is spread over the dashpots: the body would sink by it.
/// [in] before, old: boundaries and tables of the stage that has ended, at_rest: by relaxation; now, tables: of the coming
/// one; reaction: [n_owned][3] of the supports on the nodes at the end [N], empty where nothing is let go.
/// [in,out] held: [n_owned][3] N.
PetscErrorCode HoldReactions(const Mesh &mesh, const Nodes &nodes, const std::vector<Boundary> &before,
                             const Tables &old, bool at_rest, const std::vector<Boundary> &now, const Tables &tables,
                             const std::vector<double> &reaction, std::vector<double> *held);

/// Adds forces [n_owned][3] [N] to the loads of the nodes, constant in time.
void AddLoads(const std::vector<double> &force, Tables *tables);

}  // namespace cdem
