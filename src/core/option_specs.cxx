// The registry. Rows of one family stand together; sections begin at the rows that OptionSections names.
#include "core/option_names.hpp"

#include <algorithm>
#include <deque>

namespace cdem {

static std::vector<OptionSpec> &Registry() {
  using T = OptionType;
  static std::vector<OptionSpec> specs = {
      // clang-format off
      {"mesh", T::kText, "", "required", "`box`, or a gmsh file (.msh of format 2.2 or 4.1) of hexahedra, tetrahedra and wedges", ""},
      {"mesh_box_cells", T::kInts, "", "required by box", "cells of the box along x, y, z", ""},
      {"mesh_box_size", T::kReals, "m", "required by box", "edges of the box", ""},
      {"mesh_box_origin", T::kReals, "m", "0,0,0", "its corner of lowest x, y, z", ""},
      {"mesh_box_shape", T::kWord, "", "hex", "elements: hexahedra, six tetrahedra a cell, or two wedges a cell", "hex,tet,wedge"},
      {"mesh_box_jitter", T::kReal, "", "0", "inner vertices move at random by up to this share of the cell size along each axis; below 0.5", ""},
      {"seed", T::kInt, "", "1", "start of all random numbers", ""},

      {"block_<region>_law", T::kWord, "", "elastic", "law of the material", "elastic"},
      {"block_<region>_element", T::kWord, "", "full", "element form. full: full integration; bbar: mean dilatation, against locking in plastic flow and near incompressibility; onepoint: one stress point and stiffness against hourglassing, for speed (hexahedra). The law spring has its own", "full,bbar,onepoint"},
      {"block_<region>_young", T::kReal, "Pa", "required", "Young's modulus", ""},
      {"block_<region>_poisson", T::kReal, "", "required", "Poisson's ratio, above -1 and below 0.5", ""},
      {"block_<region>_density", T::kReal, "kg/m^3", "required", "density", ""},

      {"block_<region>_stress", T::kTensor, "Pa", "0", "stress that is there from the start, at z = 0; tension is positive. Interfaces carry it too", ""},
      {"block_<region>_stress_gradient_z", T::kTensor, "Pa/m", "0", "what it has more per metre of z", ""},
      {"block_<region>_release_interfaces", T::kFlag, "", "false", "law breakage: an element that breaks breaks the interfaces on its faces too", ""},
      {"block_<region>_scatter_volume", T::kReal, "m^3", "none", "volume V0 for which the Weibull means hold: an element of volume V has (V0/V)^(1/m) times them", ""},

      {"joints", T::kNames, "", "", "declares the joint sets; each needs an interface with `on joints:J`", ""},
      {"joint_<name>_file", T::kText, "", "", "its discs: lines `x y z dip dip_direction diameter` (m, degrees), with blanks or commas, `#` begins a comment", ""},
      {"joint_<name>_p32", T::kReal, "1/m", "", "instead of a file: draws discs until their area in the region, per volume of it, is nearest to this", ""},
      {"joint_<name>_count", T::kReal, "1/m^3", "", "instead of both: draws so many disc centres per volume, in the box round the region grown by the largest radius", ""},
      {"joint_<name>_dip", T::kReal, "degrees", "required by p32, count", "mean dip, from 0 to 90", ""},
      {"joint_<name>_dip_direction", T::kReal, "degrees", "required by p32, count", "mean dip direction, clockwise from +y, from 0 to 360", ""},
      {"joint_<name>_fisher", T::kReal, "", "all parallel", "kappa of Fisher's distribution about that; 0: every direction alike", ""},
      {"joint_<name>_diameter", T::kText, "m", "required by p32, count", "law of the diameter D: `fixed:d`; `uniform:min,max`; `lognormal:mean,sd` of D; `power:a,min,max`, density as D^-a", ""},
      {"joint_<name>_within", T::kText, "", "the whole mesh", "the region to which the set is confined", ""},

      {"interfaces", T::kNames, "", "", "declares the interfaces; where two claim a face the later one has it", ""},
      {"interface_<name>_on", T::kText, "", "the surface of its name", "its faces: `surface:S`; `between:A:B`, from region A to B; `inside:A`, all faces inside region A; `joints:J`, the faces that joint set J takes; `all`", ""},
      {"interface_<name>_law", T::kWord, "", "elastic", "law of the springs", "elastic,brittle,softening"},
      {"interface_<name>_kn", T::kReal, "Pa/m", "by stiffness_factor", "normal stiffness per area", ""},
      {"interface_<name>_ks", T::kReal, "Pa/m", "by stiffness_factor", "shear stiffness per area", ""},
      {"interface_<name>_stiffness_factor", T::kReal, "", "20", "without `kn` (`ks`): this times the P-wave (shear) modulus of the softer side over the distance of the two cell centres", ""},
      {"interface_<name>_kn_scatter", T::kText, "", "", "how kn varies from face to face about its value, the mean: `weibull:m`, `normal:s`, `uniform:d` (over the mean), cut at a thousandth", ""},
      {"interface_<name>_ks_scatter", T::kText, "", "", "how ks varies likewise", ""},
      {"interface_<name>_tension", T::kReal, "Pa", "that of the weaker block", "tensile strength; cut to cohesion / tan(friction)", ""},
      {"interface_<name>_cohesion", T::kReal, "Pa", "that of the weaker block", "cohesion", ""},
      {"interface_<name>_friction", T::kReal, "degrees", "that of the weaker block", "angle of friction", ""},
      {"interface_<name>_gi", T::kReal, "J/m^2", "required by softening", "fracture energy in tension", ""},
      {"interface_<name>_gii", T::kReal, "J/m^2", "required by softening", "fracture energy in shear, above friction", ""},
      {"interface_<name>_dilation", T::kReal, "degrees", "0", "laws brittle, softening: angle of dilation, at most the friction; sliding opens the joint by its tangent", ""},
      {"interface_<name>_dilation_slip", T::kReal, "m", "no end", "laws brittle, softening: the length of slip after which it dilates no more", ""},
      {"interface_<name>_initial", T::kWord, "", "intact", "laws brittle, softening: state at the start", "intact,broken"},
      {"interface_<name>_keep_tension", T::kFlag, "", "false", "law brittle: the tensile strength outlives a failure in shear", ""},

      {"boundaries", T::kNames, "", "", "declares the boundaries; where two prescribe one component the later one has it, loads add", ""},
      {"boundary_<name>_on", T::kText, "", "its name", "the surface, line or point of the mesh", ""},
      {"boundary_<name>_fix", T::kText, "", "", "components that do not move, such as `xyz` or `z`", ""},
      {"boundary_<name>_displacement", T::kReals, "m", "", "prescribed displacement from the start of the run, times the table", ""},
      {"boundary_<name>_velocity", T::kReals, "m/s", "", "prescribed velocity, times the table; of a quiet boundary the particle velocity of the plane wave that comes in", ""},
      {"boundary_<name>_components", T::kText, "", "xyz", "components that displacement or velocity prescribes; the others stay free", ""},
      {"boundary_<name>_traction", T::kReals, "Pa", "", "force per area, times the table (surfaces)", ""},
      {"boundary_<name>_pressure", T::kReal, "Pa", "", "pressure against the outward normal, times the table (surfaces)", ""},
      {"boundary_<name>_gradient_z", T::kReal, "Pa/m", "0", "times z, added to the pressure or to the size of the traction", ""},
      {"boundary_<name>_quiet", T::kFlag, "", "false", "dashpots that absorb the waves that reach the surface, which is held by nothing else", ""},
      {"boundary_<name>_release", T::kWord, "", "keep", "a later stage makes a boundary quiet that was held before: keep its last reactions as constant forces, or drop them", "keep,drop"},
      {"boundary_<name>_table", T::kText, "", "", "the table that multiplies what is prescribed; without it 1 from the start", ""},

      {"gravity", T::kReals, "m/s^2", "0,0,0", "acceleration of gravity", ""},
      {"velocity", T::kReals, "m/s", "0,0,0", "initial velocity of every region", ""},
      {"velocity_<region>", T::kReals, "m/s", "that of every region", "initial velocity of a region", ""},

      {"tables", T::kNames, "", "", "declares the time tables", ""},
      {"table_<name>_type", T::kWord, "", "required", "constant: 1; ramp: from 0 to 1 over the delay; sine: sin(2 pi f (t - delay)), 0 before; ricker: Ricker's wavelet with its peak of 1 at the delay; file: from a file", "constant,ramp,sine,ricker,file"},
      {"table_<name>_frequency", T::kReal, "Hz", "required by sine, ricker", "frequency f", ""},
      {"table_<name>_delay", T::kReal, "s", "0; required by ramp", "length of the ramp, start of the sine, peak of the wavelet", ""},
      {"table_<name>_amplitude", T::kReal, "", "1", "multiplies the table", ""},
      {"table_<name>_file", T::kText, "", "required by file", "lines `time value` or `time,value`, times ascending, `#` begins a comment; linear between them, constant outside", ""},

      {"damping_alpha", T::kReal, "1/s", "0", "Rayleigh damping by mass", ""},
      {"damping_beta", T::kReal, "s", "0", "Rayleigh damping by stiffness; it lowers the critical step", ""},
      {"damping_local", T::kReal, "", "0", "local damping: this share of a node's force opposes its motion (below 1)", ""},

      {"solve", T::kWord, "", "dynamic", "what is computed: motion in time, or relaxation to equilibrium", "dynamic,relax"},
      {"ts_max_time", T::kReal, "s", "", "the end; the last step lands on it", ""},
      {"ts_max_steps", T::kInt, "", "", "the most steps", ""},
      {"ts_dt", T::kReal, "s", "by `-ts_central_safety`", "the step", ""},
      {"ts_central_safety", T::kReal, "", "0.9", "the step, unless `-ts_dt` gives it, is this times the critical one, fitted to the end time", ""},
      {"ts_central_limit", T::kWord, "", "sharp", "the critical step: sharp: that of the highest frequency, by Krylov steps; bound: the cheap and rigorous bound below it", "sharp,bound"},
      {"ts_central_check", T::kWord, "", "error", "what to do when `-ts_dt` is above the critical step", "error,warn,off"},
      {"ts_central_batch", T::kInt, "", "1000", "most steps that TS takes as one, up to the next thing due; PETSc's monitors see batch ends", ""},
      {"relax_damping", T::kWord, "", "rayleigh", "what brings it to rest. rayleigh: by mass, critical for the lowest frequency that the motion shows (or `-damping_alpha`, where given); local: 0.8 of the force opposes the motion (or `-damping_local`); combined: half of that opposes the motion, half the change of the force; kinetic: velocities are cleared at every peak of the kinetic energy", "local,kinetic,rayleigh,combined"},
      {"relax_ratio", T::kReal, "", "1e-7", "in balance: at most this ratio of unbalanced forces to forces of corners and springs, at two checks in a row", ""},
      {"relax_kinetic", T::kReal, "", "1e-12", "and at most this share of the largest kinetic energy", ""},
      {"relax_density_scaling", T::kFlag, "", "true", "masses, not weights, are scaled so that every node runs at one step", ""},
      {"relax_max_steps", T::kInt, "steps", "1000000", "not in balance by then: an error", ""},
      {"relax_interval", T::kInt, "steps", "100", "between two checks", ""},
      {"deterministic", T::kFlag, "", "false", "the reference way, whose results do not depend on ranks", ""},

      {"stages", T::kNames, "", "", "declares the stages of a run, in order; `-stage_<name>_<option>` overrides that option from this stage on", ""},
      {"stage_<name>_remove", T::kNames, "", "", "regions that leave at its beginning, with their springs", ""},
      {"stage_<name>_reset", T::kWord, "", "", "what is set back at its beginning: displacements are reported from there on; forces stay", "displacement"},
      {"stage_<name>_intact", T::kFlag, "", "false", "nothing fails in this stage; what has failed stays so", ""},
      {"stage_<name>_strength_factor", T::kReal, "", "1", "strengths are divided by it (cohesion, tension, the tangent of friction), from this stage on", ""},

      {"monitor_progress", T::kViewer, "", "", "prints step, time, rate and time left", ""},
      {"monitor_progress_interval", T::kInt, "steps", "20 lines a run", "every so many steps", ""},
      {"monitor_progress_interval_time", T::kReal, "s", "", "every so many seconds of the scene", ""},
      {"monitor_energy", T::kViewer, "", "", "prints energies and momentum, and keeps the energy balance: losses, works and its error", ""},
      {"monitor_energy_interval", T::kInt, "steps", "100", "every so many steps", ""},
      {"monitor_energy_interval_time", T::kReal, "s", "", "every so many seconds of the scene", ""},
      {"monitor_convergence", T::kViewer, "", "", "prints kinetic energy, unbalanced force ratio, broken springs and the share of broken blocks", ""},
      {"monitor_convergence_interval", T::kInt, "steps", "100", "every so many steps", ""},
      {"monitor_convergence_interval_time", T::kReal, "s", "", "every so many seconds of the scene", ""},
      {"histories", T::kNames, "", "", "declares the histories, columns of histories.csv", ""},
      {"history_<name>_at", T::kReals, "m", "required", "the place; the nearest node is taken, at a split vertex that of the lowest-numbered cell", ""},
      {"history_<name>_of", T::kWord, "", "required", "the quantity", "displacement_x,displacement_y,displacement_z,velocity_x,velocity_y,velocity_z"},
      {"history_interval", T::kInt, "steps", "1", "every so many steps", ""},

      {"output", T::kText, "", "no files", "the folder for all results; one that holds results is refused", ""},
      {"output_overwrite", T::kFlag, "", "false", "replaces the results in the folder", ""},
      {"output_interval", T::kInt, "steps", "first and last step", "a frame of fields every so many steps", ""},
      {"output_interval_time", T::kReal, "s", "", "a frame of fields every so many seconds of the scene", ""},
      {"output_fields", T::kNames, "", "all", "the fields of a frame", "displacement,velocity,stress,region,opening,slip,normal_stress,shear_stress,state,interface,plastic_strain,broken,broken_time,damage"},
      {"checkpoint_interval", T::kInt, "steps", "none", "a file checkpoint_<step>.h5 in the folder every so many steps and at the end; the last two are kept", ""},
      {"checkpoint_interval_time", T::kReal, "s", "", "the same every so many seconds of the scene", ""},
      {"restart", T::kText, "", "", "starts from this checkpoint of the same scene; in its own folder (`-output`) histories and frames go on", ""},

      {"device", T::kWord, "", "auto", "where it is computed; auto: cuda if this build and machine have it", "auto,cpu,cuda"},
      {"precision", T::kWord, "", "double", "arithmetic of elements. single: faster in large elastic scenes, by the reference way; positions, displacements, velocities and sums stay double", "double,single"},
      {"central_way", T::kWord, "", "auto", "way of computing a step; assembled: a product with the stiffness as a matrix of PETSc, to compare with, which auto never takes", "auto,reference,rows,stencil,assembled"},
      {"central_mat_type", T::kText, "", "baij", "type of the matrix of `-central_way assembled`, in PETSc's words", ""},
      {"elements_per_block", T::kInt, "", "32", "elements that a thread block of the GPU takes; a multiple of 32 from 32 to 256", ""},
      {"help_options", T::kWord, "", "", "prints these options and ends: as text, or as the page docs/options.md", "plain,markdown"},
      // clang-format on
  };
  return specs;
}

const std::vector<OptionSpec> &OptionSpecs() { return Registry(); }

const std::vector<OptionSection> &OptionSections() {
  static const std::vector<OptionSection> sections = {
      {"mesh", "Mesh",
       "The box is region `box`; its sides are the surfaces `xmin`, `xmax`, `ymin`, `ymax`, `zmin`, `zmax`."},
      {"block_<region>_law", "Blocks", "Every region of the mesh needs its material."},
      {"joints", "Joints",
       "Sets of discs, drawn at random or read from a file. A face between two elements is taken where a disc "
       "separates "
       "their centres."},
      {"interfaces", "Interfaces", "Faces at which the mesh is split and joined by springs."},
      {"boundaries", "Boundaries", ""},
      {"gravity", "Gravity and initial velocity", ""},
      {"tables", "Time tables", ""},
      {"damping_alpha", "Damping", ""},
      {"solve", "Solution", "How long it runs is said with PETSc's `-ts_max_time` or `-ts_max_steps` (below)."},
      {"stages", "Stages",
       "Every stage goes on from the end of the one before, and has every option that it does not override. "
       "`remove`, `reset` and `intact` hold for their stage alone. Times of tables, `-ts_max_time` and `-ts_max_steps` "
       "count from its beginning."},
      {"monitor_progress", "Watching",
       "A monitor prints to the terminal, or where PETSc's viewer syntax says: `-monitor_energy ascii:energy.txt`."},
      {"output", "Output", ""},
      {"device", "Machine and help", ""},
  };
  return sections;
}

static std::deque<std::string> &Texts() {
  static std::deque<std::string> texts;  // never moves what it holds
  return texts;
}

static const char *Keep(const std::string &text) {
  Texts().push_back(text);
  return Texts().back().c_str();
}

void AddOption(const OptionSpec &spec) {
  std::vector<OptionSpec> &specs = Registry();
  const auto same = [&](const OptionSpec &other) { return std::string(other.name) == spec.name; };
  const auto found = std::find_if(specs.begin(), specs.end(), same);
  if (found != specs.end()) {
    std::vector<std::string> choices = SplitList(found->choices);
    std::string all = found->choices;
    for (const std::string &word : SplitList(spec.choices))
      if (std::find(choices.begin(), choices.end(), word) == choices.end()) all += (all.empty() ? "" : ",") + word;
    if (all != found->choices) found->choices = Keep(all);
    // laws may differ in what they take without it
    const std::string required = "required by ", other = spec.fallback, one = found->fallback;
    if (one == "required" || one.find(other) != std::string::npos) return;
    const bool both =
        one.compare(0, required.size(), required) == 0 && other.compare(0, required.size(), required) == 0;
    if (both && one.find(other.substr(required.size())) != std::string::npos) return;
    found->fallback = Keep(one + (both ? ", " + other.substr(required.size()) : "; " + other));
    return;
  }
  auto place = specs.end();
  for (auto row = specs.begin(); row != specs.end(); ++row)
    if (OptionPattern(*row).family == OptionPattern(spec).family) place = row + 1;
  specs.insert(place,
               {Keep(spec.name), spec.type, Keep(spec.unit), Keep(spec.fallback), Keep(spec.text), Keep(spec.choices)});
}

}  // namespace cdem
