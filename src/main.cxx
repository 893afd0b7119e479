// cdem: the continuum-based discrete element method. Options in, monitors and frames out.
#include "core/error.hpp"
#include "core/events.hpp"
#include "core/options.hpp"
#include "core/start.hpp"
#include "physics/law_options.hpp"
#include "simulation.hpp"

static const char kHelp[] =
    "cdem computes the dynamics and progressive failure of rock and soil by the continuum-based discrete element "
    "method.\n"
    "  cdem -options_file scene.yaml [-option value ...]\n";

static PetscErrorCode Run() {
  PetscFunctionBeginUser;
  cdem::Simulation simulation(PETSC_COMM_WORLD);
  PetscCall(simulation.SetUp());
  PetscCall(simulation.Solve());
  PetscCall(simulation.Finish());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Help(bool *shown) {
  PetscFunctionBeginUser;
  PetscBool help = PETSC_FALSE;
  std::string format;
  bool wanted = false;
  cdem::Options options(PETSC_COMM_WORLD);
  PetscCall(PetscOptionsHasName(nullptr, nullptr, "-help", &help));
  PetscCall(options.Word("help_options", &format, &wanted));
  *shown = help || wanted;
  if (*shown) PetscCall(cdem::PrintOptions(PETSC_COMM_WORLD, format == "markdown"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  PetscErrorCode ierr = cdem::InstallErrorHandler(argc, argv);
  if (!ierr) ierr = cdem::PrepareGpuMpi();
  if (!ierr) ierr = PetscInitialize(&argc, &argv, nullptr, kHelp);
  if (ierr) cdem::ExitOnError();
  cdem::RegisterLawOptions();
  bool shown = false;
  ierr = cdem::CheckArguments(argc, argv);
  if (!ierr) ierr = cdem::CheckOptionFiles(argc, argv);
  if (!ierr) ierr = cdem::RegisterEvents();
  if (!ierr) ierr = cdem::RegisterTSCentral();
  if (!ierr) ierr = Help(&shown);
  if (!ierr && !shown) ierr = Run();
  if (ierr) cdem::ExitOnError();
  return PetscFinalize() ? 1 : 0;
}
