"""Small good scenes that show every law, form, interface, joint set, boundary, table and watcher, as options and texts."""
import mesh_seeds
import msh

BOX = {"mesh": "box", "mesh_box_cells": "2,2,2", "mesh_box_size": "1,1,2", "block_young": "1e9", "block_poisson": "0.25",
       "block_density": "2000", "boundaries": "zmin", "boundary_zmin_fix": "xyz", "gravity": "0,0,-9.81", "ts_max_steps": "2",
       "output": "out"}
MOHR = {"block_law": "mohr_coulomb", "block_cohesion": "1e6", "block_friction": "30", "block_tension": "1e5"}
BRITTLE = {"interfaces": "i", "interface_i_on": "all", "interface_i_law": "brittle", "interface_i_tension": "1e5",
           "interface_i_cohesion": "2e5", "interface_i_friction": "30"}
FILE = {"mesh": "good.msh", "block_young": "1e9", "block_poisson": "0.2", "block_density": "2000", "boundaries": "base",
        "boundary_base_fix": "xyz", "ts_max_steps": "2", "output": "out"}
PATH = "# s, share\n0 0\n1e-4, 0.5\n2.5e-4 1.0\n4e-4 -1e-1  # back\n"
DISCS = "# x y z dip dip_direction diameter\n0.5 0.5 1.0 0 0 3\n0.5, 0.5, 1.2, 80, 90, 2.5\n9 9 9 10 10 1\n"

SCENES = {
    "elastic": {**BOX, "mesh_box_origin": "-1,0,0.5", "mesh_box_jitter": "0.1", "seed": "3", "block_element": "onepoint",
                "damping_alpha": "10", "damping_beta": "1e-6", "velocity": "0,0,0.1", "histories": "top,foot",
                "history_top_at": "0,0,2.5", "history_top_of": "displacement_z", "history_foot_at": "0,0,0.5",
                "history_foot_of": "velocity_x", "history_interval": "1", "monitor_energy_interval": "1", "monitor_energy": "",
                "ts_central_safety": "0.5", "ts_central_batch": "7", "deterministic": "true", "output_interval": "1"},
    "drucker": {**BOX, **MOHR, "mesh_box_shape": "tet", "mesh_box_cells": "1,1,2", "block_law": "drucker_prager",
                "block_element": "bbar", "block_cone": "inscribed", "block_gf": "1000", "block_dilation": "10",
                "block_residual_cohesion": "1e5", "block_residual_friction": "25", "boundaries": "zmin,zmax,side",
                "boundary_side_on": "xmax", "boundary_side_traction": "0,0,1e4", "boundary_side_gradient_z": "100",
                "boundary_zmax_pressure": "1e5", "boundary_zmax_table": "up", "tables": "up", "table_up_type": "ramp",
                "table_up_delay": "0.01", "table_up_amplitude": "2"},
    "mohr": {**BOX, **MOHR, "mesh_box_shape": "wedge", "block_element": "full", "block_dilation": "5", "boundaries": "zmin,zmax",
             "boundary_zmax_velocity": "0,0,-1e-3", "boundary_zmax_components": "z", "boundary_zmax_table": "s", "tables": "s",
             "table_s_type": "sine", "table_s_frequency": "100", "table_s_delay": "1e-5", "velocity_box": "0.1,0,0",
             "output_fields": "displacement,velocity,region,stress", "output_interval_time": "1e-4"},
    "breakage": {**BOX, **MOHR, "block_law": "breakage", "block_residual_cohesion": "1e5", "block_residual_friction": "20",
                 "block_cohesion_scatter": "weibull:5", "block_tension_scatter": "uniform:0.3", "block_scatter_volume": "0.1",
                 "block_release_interfaces": "true", **BRITTLE, "interface_i_dilation": "10", "interface_i_dilation_slip": "1e-3",
                 "interface_i_tension_scatter": "normal:0.2", "interface_i_kn_scatter": "uniform:0.1",
                 "interface_i_keep_tension": "false", "monitor_convergence": "", "monitor_progress": ""},
    "springs": {**BOX, **MOHR, "block_law": "spring", "block_residual_friction": "20", **BRITTLE, "interface_i_law": "softening",
                "interface_i_tension": "1e5", "interface_i_cohesion": "2e5", "interface_i_gi": "500", "interface_i_gii": "5000",
                "interface_i_kn": "1e11", "interface_i_ks": "1e11", "ts_max_steps": "3", "ts_max_time": "1"},
    "random": {**BOX, **BRITTLE, "interfaces": "i,k", "interface_i_on": "joints:flat", "interface_i_stiffness_factor": "5",
               "interface_k_on": "joints:steep", "interface_k_law": "elastic", "joints": "flat,steep", "joint_flat_p32": "2",
               "joint_flat_dip": "20", "joint_flat_dip_direction": "90", "joint_flat_fisher": "30",
               "joint_flat_diameter": "power:2.5,1,3", "joint_steep_count": "3", "joint_steep_dip": "80",
               "joint_steep_dip_direction": "10", "joint_steep_diameter": "lognormal:2,0.5", "joint_steep_within": "box",
               "boundaries": "zmin,zmax", "boundary_zmax_velocity": "0,0,1e-3", "boundary_zmax_table": "p", "tables": "p,c",
               "table_p_type": "ricker", "table_p_frequency": "100", "table_p_delay": "0.01", "table_c_type": "constant",
               "boundary_zmin_table": "c", "boundary_zmin_fix": "xy", "boundary_zmin_pressure": "10"},
    "discs": {**BOX, **BRITTLE, "interface_i_on": "joints:j", "interface_i_initial": "broken", "joints": "j",
              "joint_j_file": "discs.txt"},
    "path": {**BOX, "boundaries": "zmin,zmax", "boundary_zmax_displacement": "0,0,1e-6", "boundary_zmax_components": "z",
             "boundary_zmax_table": "path", "tables": "path", "table_path_type": "file", "table_path_file": "path.txt",
             "histories": "top", "history_top_at": "0,0,2", "history_top_of": "displacement_z", "ts_max_steps": "6",
             "ts_dt": "1e-4", "ts_central_check": "error"},
    "regions": {**FILE, "boundaries": "base,edge,tip", "boundary_edge_fix": "x", "boundary_tip_velocity": "0,0,1",
                "block_cap_young": "2e9", "block_cap_law": "elastic", "interfaces": "fault", "interface_fault_law": "brittle",
                "interface_fault_tension": "1e5", "interface_fault_cohesion": "1e5", "interface_fault_friction": "20",
                "interface_fault_keep_tension": "true", "velocity_cap": "0,0,1"},
    "between": {**FILE, "interfaces": "b", "interface_b_on": "between:hard_rock:cap", "interface_b_kn": "1e10",
                "interface_b_ks": "1e9", "ts_central_check": "warn", "output_overwrite": "true", "central_way": "reference",
                "device": "cpu"},
    "inside": {**FILE, "mesh": "tets.msh", "interfaces": "n", "interface_n_on": "inside:mesh", "ts_max_steps": "1e1"},
}
TEXTS = {"path.txt": PATH.encode(), "discs.txt": DISCS.encode(), "good.msh": msh.write(mesh_seeds.bricks(), 22, False),
         "tets.msh": msh.write(mesh_seeds.tets(), 41, False)}


def files(options):
    """The files that a scene names."""
    return {value: TEXTS[value] for value in options.values() if value in TEXTS}
