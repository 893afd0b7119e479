// The registry as text: -help and the page docs/options.md.
#include "core/option_names.hpp"

namespace cdem {

static std::string WithoutTicks(std::string text) {
  std::string out;
  for (char c : text)
    if (c != '`') out += c;
  return out;
}

/// One line of text or one row of a Markdown table.
static std::string Row(const std::string &name, const std::string &type, const std::string &fallback,
                       const std::string &text, bool markdown) {
  if (markdown) return "| `-" + name + "` | " + type + " | " + fallback + " | " + text + " |\n";
  return "  -" + name + ": " + type + (fallback.empty() ? "" : " (" + fallback + ")") + "\n      " +
         WithoutTicks(text) + "\n";
}

static std::string Heading(const std::string &title, const std::string &text, bool markdown) {
  if (!markdown) return "\n" + title + (text.empty() ? "" : ": " + WithoutTicks(text)) + "\n";
  return "\n## " + title + "\n" + text + (text.empty() ? "" : "\n") +
         "\n| option | value | default | what it is |\n|---|---|---|---|\n";
}

static const char kMarkdownStart[] =
    "# Options\n"
    "<!-- Written by `cdem -help_options markdown`; do not edit. -->\n"
    "A scene is a list of PETSc options: on the command line (`-gravity 0,0,-9.81`), in a file of such options, or in "
    "a YAML\n"
    "file, where nested keys are joined by `_` and lists by commas: `block: {rock: {young: 1.0e10}}` is\n"
    "`-block_rock_young 1.0e10`. Later options win. Units are SI, angles are in degrees.\n"
    "\n"
    "A plural option declares names, the singular one with a name describes it, and without the name it holds for "
    "all:\n"
    "`-boundaries base,top`, then `-boundary_base_fix xyz`; `-boundary_fix xyz` is for every boundary without a `fix` "
    "of its\n"
    "own. Regions and surfaces have their names from the mesh. An option that is unknown, or that the scene has no use "
    "for,\n"
    "is an error.\n";

static const char kPlainStart[] =
    "Options of cdem (SI units, degrees; lists joined by commas; the default in brackets).\n"
    "An option of a family without the name in < > holds for all: -block_young is for every region.\n";

PetscErrorCode PrintOptions(MPI_Comm comm, bool markdown) {
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "%s", markdown ? kMarkdownStart : kPlainStart));
  for (const OptionSpec &spec : OptionSpecs()) {
    for (const OptionSection &section : OptionSections())
      if (std::string(section.first) == spec.name)
        PetscCall(PetscPrintf(comm, "%s", Heading(section.title, section.text, markdown).c_str()));
    const std::string row = Row(spec.name, Expected(spec), spec.fallback, spec.text, markdown);
    PetscCall(PetscPrintf(comm, "%s", row.c_str()));
  }
  const char *about = "PETSc has many more; those of its time stepper, meshes and logging work as usual.";
  PetscCall(PetscPrintf(comm, "%s", Heading("Of PETSc", about, markdown).c_str()));
  for (const PetscOptionRow &row : PetscOptionRows())
    PetscCall(PetscPrintf(comm, "%s", Row(row.name, row.type, row.fallback, row.text, markdown).c_str()));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
