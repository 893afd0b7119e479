// A scene with quiet boundaries for tests of ranks, batches and the GPU.
#pragma once
#include "run_scene.hpp"

namespace cdem {

/// A jointed block with dashpots below and on two sides, whose edges they share; a wave comes in from below, another side
/// holds a component of some of those nodes, the top is loaded. [in] more: further options.
inline std::string QuietScene(const std::string &shape, const std::string &more = "") {
  return "-mesh box -mesh_box_shape " + shape + " -mesh_box_cells 6,5,4 -mesh_box_size 6,5,4 -mesh_box_jitter 0.15" +
         kRock +
         " -interfaces j -interface_j_on all -interface_j_law elastic -velocity 0.1,-0.2,0 -damping_alpha 2 "
         "-boundaries zmin,xmin,xmax,ymax,zmax -boundary_zmin_quiet -boundary_zmin_velocity 0.4,0.1,0.3 "
         "-boundary_zmin_table pulse -boundary_xmin_quiet -boundary_xmax_quiet -boundary_xmax_traction 1e4,0,-2e4 "
         "-boundary_ymax_fix y -boundary_zmax_pressure 1e4 -tables pulse -table_pulse_type sine "
         "-table_pulse_frequency 40 " +
         more;
}

}  // namespace cdem
