"""Bad input: one message that says what and where, an exit code other than 0, and nothing written."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import harness  # noqa: E402

GOOD = {
    "mesh": "box", "mesh_box_cells": (2, 2, 2), "mesh_box_size": (2, 2, 2), "block_law": "elastic", "block_young": 1e9,
    "block_poisson": 0.25, "block_density": 2000.0, "gravity": (0, 0, -9.81), "boundaries": "zmin",
    "boundary_zmin_fix": "xyz", "ts_max_steps": 5, "output": "out",
}
MOHR = {"block_law": "mohr_coulomb", "block_cohesion": 1e6, "block_friction": 30.0}
JOINTS = {"interfaces": "joints", "interface_joints_on": "all", "interface_joints_law": "brittle",
          "interface_joints_tension": 1e5, "interface_joints_cohesion": 1e5, "interface_joints_friction": 30.0}
DISCS = {"joints": "j", "joint_j_p32": 1.0, "joint_j_dip": 30.0, "joint_j_dip_direction": 40.0,
         "joint_j_diameter": "fixed:2", "interfaces": "i", "interface_i_on": "joints:j"}
SPRINGS = {"block_law": "spring", "block_tension": 1e5, "block_cohesion": 1e5, "block_friction": 30.0}
DROP = object()  # as a value: the option is left out
FILE = {"joint_j_p32": DROP, "joint_j_dip": DROP, "joint_j_dip_direction": DROP, "joint_j_diameter": DROP}


def changed(changes):
    return {key: value for key, value in {**GOOD, **changes}.items() if value is not DROP}


def files(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def text_of(done):
    return done.stdout + done.stderr


def assert_refused(folder, options, words, ranks=1):
    """The run fails with all words in its message, without a traceback, and writes nothing."""
    folder.mkdir(parents=True, exist_ok=True)
    before = files(folder)
    done = harness.call(folder, options, ranks=ranks, timeout=120)
    text = text_of(done)
    assert done.returncode != 0, f"accepted:\n{text[-2000:]}"
    assert done.returncode > 0 and done.returncode < 128, f"ended by a signal:\n{text[-2000:]}"
    after = files(folder)
    after.pop("scene.txt")
    before.pop("scene.txt", None)
    assert after == before, f"written: {sorted(set(after) - set(before))}"
    message = [line for line in text.splitlines() if "cdem: error:" in line]
    assert len(message) == 1, f"not one message:\n{text[-3000:]}"
    where = text[text.index("cdem: error:"):].lower()
    missing = [word for word in words if word.lower() not in where]
    assert not missing, f"does not say {missing}:\n{where[:1500]}"
    assert "PETSC ERROR" not in text, text[-2000:]
    return where


OPTIONS = {
    # unknown and misspelt options, with the nearest known
    "misspelt option": ({"gravty": (0, 0, -1)}, ["-gravty", "-gravity"]),
    "misspelt key of a block": ({"block_yung": 1e9}, ["-block_yung", "young"]),
    "misspelt key of a named block": ({"block_box_densty": 1e3}, ["-block_box_densty", "density"]),
    "misspelt key of a boundary": ({"boundary_zmin_fixx": "x"}, ["-boundary_zmin_fixx", "fix"]),
    "misspelt key of the box": ({"mesh_box_cels": (1, 1, 1)}, ["-mesh_box_cels", "-mesh_box_cells"]),
    "misspelt option of the stepping": ({"ts_central_bach": 5}, ["-ts_central_bach", "-ts_central_batch"]),
    "misspelt output": ({"ouput_interval": 5}, ["-ouput_interval", "-output_interval"]),
    "option of another kind of mesh": ({"interface_joints_law": "brittle"}, ["-interface_joints_law", "joints"]),
    # names
    "unknown region": ({"block_granite_young": 1e9}, ["-block_granite_young", "granite", "box"]),
    "unknown surface": ({"boundaries": ("zmin", "bottom"), "boundary_bottom_fix": "z"}, ["bottom", "zmin", "zmax"]),
    "unknown surface in on": ({"boundary_zmin_on": "floor"}, ["floor", "zmin", "zmax"]),
    "boundary not declared": ({"boundary_zmax_fix": "z"}, ["-boundary_zmax_fix", "zmax", "-boundaries"]),
    "boundary not described": ({"boundaries": ("zmin", "zmax")}, ["'zmax'", "fix", "velocity"]),
    "unknown surface of an interface": ({**JOINTS, "interface_joints_on": "surface:fault"}, ["fault", "-interface_joints_on"]),
    "unknown region of an interface": ({**JOINTS, "interface_joints_on": "between:box:cap"}, ["cap", "box"]),
    "interface on a side of the body": ({**JOINTS, "interface_joints_on": "surface:zmin"}, ["joints", "zmin"]),
    "unknown kind of interface": ({**JOINTS, "interface_joints_on": "everywhere"}, ["everywhere", "inside:", "all"]),
    "unknown table": ({"boundary_zmin_fix": DROP, "boundary_zmin_velocity": (0, 0, 1), "boundary_zmin_table": "quake"},
                      ["quake"]),
    "unknown region of a velocity": ({"velocity_granite": (0, 0, 1)}, ["-velocity_granite", "box"]),
    # joint sets
    "unknown joint set": ({**DISCS, "interface_i_on": "joints:k"}, ["-interface_i_on", "joints:k", "'k'", "are: j"]),
    "no joint set": ({"interfaces": "i", "interface_i_on": "joints:k"}, ["'k'", "-joints"]),
    "joint set without an interface": ({**DISCS, "interfaces": DROP, "interface_i_on": DROP}, ["-joints", "'j'", "joints:j"]),
    "joint set without discs": ({**DISCS, "joint_j_p32": DROP}, ["'j'", "-joint_j_p32", "-joint_j_count", "-joint_j_file"]),
    "two sources of discs": ({**DISCS, "joint_j_count": 1.0}, ["'j'", "more than one", "-joint_j_count"]),
    "p32 negative": ({**DISCS, "joint_j_p32": -1.0}, ["-joint_j_p32", "-1", "above 0"]),
    "too many discs": ({**DISCS, "joint_j_p32": 1e10}, ["-joint_j_p32", "discs"]),
    "dip above 90": ({**DISCS, "joint_j_dip": 100.0}, ["-joint_j_dip", "100", "90"]),
    "no dip direction": ({**DISCS, "joint_j_dip_direction": DROP}, ["-joint_j_dip_direction", "degrees"]),
    "kappa negative": ({**DISCS, "joint_j_fisher": -2.0}, ["-joint_j_fisher", "-2"]),
    "unknown law of the diameter": ({**DISCS, "joint_j_diameter": "gamma:1,2"}, ["-joint_j_diameter", "gamma", "lognormal"]),
    "diameter law short of a number": ({**DISCS, "joint_j_diameter": "power:2.5,1"}, ["-joint_j_diameter", "power:a,min,max"]),
    "diameter cut-offs reversed": ({**DISCS, "joint_j_diameter": "power:2.5,9,1"}, ["-joint_j_diameter", "max above min"]),
    "unknown region of a joint set": ({**DISCS, "joint_j_within": "rock"}, ["-joint_j_within", "rock", "box"]),
    "misspelt key of a joint set": ({**DISCS, "joint_j_dipp": 3.0}, ["-joint_j_dipp", "dip"]),
    "joint file missing": ({**DISCS, **FILE, "joint_j_file": "nowhere.txt"}, ["-joint_j_file", "nowhere.txt"]),
    "dip of a joint file": ({**DISCS, **FILE, "joint_j_dip": 30.0, "joint_j_file": "nowhere.txt"}, ["-joint_j_file"]),
    "joint set that takes no face": ({**DISCS, "joint_j_p32": DROP, "joint_j_count": 0.1, "joint_j_diameter": "fixed:0.001"},
                                     ["interface 'i'", "no face"]),
    # laws and their numbers
    "unknown block law": ({"block_law": "elastick"}, ["-block_law", "elastick", "elastic"]),
    "unknown interface law": ({**JOINTS, "interface_joints_law": "britle"}, ["-interface_joints_law", "britle", "brittle"]),
    "blocks' friction of 95 degrees": ({**MOHR, "block_friction": 95.0}, ["-block_friction", "95", "89.9"]),
    "blocks' negative tension": ({**MOHR, "block_tension": -1.0}, ["-block_tension", "-1", "at least 0"]),
    "blocks' dilation above friction": ({**MOHR, "block_dilation": 40.0}, ["box", "dilation 40", "friction 30"]),
    "blocks without cohesion": ({**MOHR, "block_cohesion": DROP}, ["box", "-block_box_cohesion", "Pa"]),
    "breakage without tension": ({**MOHR, "block_law": "breakage"}, ["box", "tension", "Pa"]),
    "residual cohesion above cohesion": ({**MOHR, "block_law": "breakage", "block_tension": 1e5,
                                          "block_residual_cohesion": 2e6}, ["residual_cohesion", "2e+06", "1e+06"]),
    "unknown cone": ({**MOHR, "block_law": "drucker_prager", "block_cone": "round"},
                     ["-block_cone", "round", "outer", "middle", "inscribed"]),
    "residual strength without gf": ({**MOHR, "block_law": "drucker_prager", "block_residual_cohesion": 1e5}, ["box", "gf"]),
    "softening to the same strength": ({**MOHR, "block_law": "drucker_prager", "block_gf": 100.0,
                                        "block_residual_cohesion": 1e6}, ["gf", "residual_cohesion"]),
    "cone of another law": ({**MOHR, "block_cone": "outer"}, ["-block_cone"]),
    "no material": ({"block_law": DROP, "block_young": DROP, "block_poisson": DROP, "block_density": DROP}, ["box"]),
    "no density": ({"block_density": DROP}, ["density", "box"]),
    "no young": ({"block_young": DROP}, ["young", "box"]),
    "density zero": ({"block_density": 0.0}, ["density", "0"]),
    "density negative": ({"block_density": -5.0}, ["density", "-5"]),
    "poisson one half": ({"block_poisson": 0.5}, ["poisson", "0.5"]),
    "poisson below -1": ({"block_poisson": -1.5}, ["poisson", "-1.5"]),
    "young zero": ({"block_young": 0.0}, ["young", "0"]),
    "friction of 95 degrees": ({**JOINTS, "interface_joints_friction": 95.0}, ["friction", "95"]),
    "negative stiffness": ({**JOINTS, "interface_joints_kn": -1e9}, ["kn", "-1e"]),
    "no strength": ({**JOINTS, "interface_joints_cohesion": DROP}, ["cohesion", "joints"]),
    "negative damping": ({"damping_alpha": -1.0}, ["-damping_alpha"]),
    # element forms and laws that do not go together
    "unknown element form": ({"block_element": "fool"}, ["-block_element", "fool", "full"]),
    "form that tetrahedra lack": ({"mesh_box_shape": "tet", "block_element": "onepoint"}, ["box", "tetrahedra", "onepoint", "full"]),
    "form that wedges lack": ({"mesh_box_shape": "wedge", "block_element": "onepoint"}, ["box", "wedges", "onepoint", "full, bbar"]),
    "springs of tetrahedra": ({**SPRINGS, "mesh_box_shape": "tet"}, ["box", "tetrahedra", "spring", "hexahedra"]),
    "springs of wedges": ({**SPRINGS, "mesh_box_shape": "wedge"}, ["box", "wedges", "spring", "hexahedra"]),
    "springs with an element form": ({**SPRINGS, "block_element": "full"}, ["box", "spring", "-block_element", "leave it out"]),
    "springs without strength": ({**SPRINGS, "block_tension": DROP}, ["box", "tension"]),
    "the form of springs by its name": ({"block_element": "spring"}, ["-block_element", "spring", "onepoint"]),
    # values
    "no value": ({"gravity": None}, ["-gravity"]),
    "too few numbers": ({"gravity": (0, -9.81)}, ["-gravity", "3"]),
    "too many numbers": ({"gravity": (0, 0, 0, -9.81)}, ["-gravity", "3"]),
    "not a number": ({"block_young": "stiff"}, ["-block_young", "stiff"]),
    "nan": ({"block_young": "nan"}, ["-block_young", "nan"]),
    "infinite": ({"gravity": "0,0,-inf"}, ["-gravity", "inf"]),
    "unknown direction": ({"boundary_zmin_fix": "xw"}, ["-boundary_zmin_fix", "xw"]),
    "not a word of the list": ({"ts_central_check": "perhaps"}, ["-ts_central_check", "perhaps", "warn"]),
    "no cells": ({"mesh_box_cells": (2, 0, 2)}, ["-mesh_box_cells", "0"]),
    "no size": ({"mesh_box_size": (2, -1, 2)}, ["-mesh_box_size", "-1"]),
    "unknown shape": ({"mesh_box_shape": "prism"}, ["-mesh_box_shape", "prism", "wedge"]),
    "no mesh": ({"mesh": DROP, "mesh_box_cells": DROP, "mesh_box_size": DROP}, ["-mesh"]),
    "unknown history": ({"histories": "top", "history_top_at": (1, 1, 2), "history_top_of": "temperature"},
                        ["-history_top_of", "temperature", "displacement_z"]),
    "history without a place": ({"histories": "top"}, ["-history_top_at"]),
    "unknown table type": ({"tables": "t", "table_t_type": "square", "boundary_zmin_fix": DROP,
                            "boundary_zmin_velocity": (0, 0, 1), "boundary_zmin_table": "t"}, ["-table_t_type", "square", "ricker"]),
    "table file missing": ({"tables": "t", "table_t_type": "file", "table_t_file": "nowhere.txt", "boundary_zmin_fix": DROP,
                            "boundary_zmin_velocity": (0, 0, 1), "boundary_zmin_table": "t"}, ["nowhere.txt"]),
    "jitter of a whole cell": ({"mesh_box_jitter": 0.6}, ["-mesh_box_jitter", "0.6"]),
    "no end": ({"ts_max_steps": DROP}, ["-ts_max_time", "-ts_max_steps"]),
    "step zero": ({"ts_dt": 0.0}, ["-ts_dt", "0"]),
    "step negative": ({"ts_dt": -1e-4}, ["-ts_dt"]),
    "end before the start": ({"ts_max_steps": DROP, "ts_max_time": -1.0}, ["-ts_max_time", "-1"]),
    "safety above 1": ({"ts_central_safety": 1.5}, ["-ts_central_safety", "1.5"]),
    # quiet boundaries
    "quiet and fixed": ({"boundary_zmin_quiet": None}, ["'zmin'", "quiet", "-boundary_zmin_fix"]),
    "quiet and moved": ({"boundary_zmin_fix": DROP, "boundary_zmin_quiet": None, "boundary_zmin_displacement": (0, 0, 1)},
                        ["'zmin'", "quiet", "displacement", "velocity"]),
    "quiet with a table alone": ({"boundary_zmin_fix": DROP, "boundary_zmin_quiet": None, "boundary_zmin_table": "t",
                                  "tables": "t", "table_t_type": "sine", "table_t_frequency": 5.0},
                                 ["-boundary_zmin_table", "'zmin'", "quiet", "multiply"]),
    "quiet that is neither yes nor no": ({"boundary_zmin_quiet": "absorb"}, ["-boundary_zmin_quiet", "absorb"]),
    "components of a quiet boundary without a wave": ({"boundary_zmin_fix": DROP, "boundary_zmin_quiet": None,
                                                       "boundary_zmin_components": "z"}, ["components", "'zmin'"]),
    # known words of no use here, and parts of the language that this version lacks
    "strength for a law without": ({**JOINTS, "interface_joints_law": "elastic"}, ["-interface_joints_"]),
    "a table that nobody uses": ({"tables": "t"}, ["'t'", "-table_t_type"]),
    "a boundary twice": ({"boundaries": ("zmin", "zmin")}, ["-boundaries", "zmin"]),
    "equilibrium": ({"solve": "relax"}, ["-solve", "relax"]),
    "stage not declared": ({"stages": "dig", "stage_digg_remove": "box"}, ["-stage_digg_remove", "digg", "dig"]),
    "stage removes an unknown region": ({"stages": "dig", "stage_dig_remove": "cap"}, ["-stage_dig_remove", "cap", "box"]),
    "stage removes all": ({"stages": "dig", "stage_dig_remove": "box"}, ["-stage_dig_remove", "nothing"]),
    "stage changes the mesh": ({"stages": "dig", "stage_dig_mesh_box_cells": (3, 3, 3)}, ["-stage_dig_mesh_box_cells", "stage"]),
    "stage with a bad value": ({"stages": ("a", "b"), "stage_b_block_young": -1.0}, ["-block_young", "-1"]),
    "stage with a misspelt option": ({"stages": "a", "stage_a_gravty": (0, 0, 1)}, ["stage a", "-gravty", "-gravity"]),
    "strength factor zero": ({"stages": "a", "stage_a_strength_factor": 0.0}, ["-stage_a_strength_factor", "0"]),
    "unknown reset": ({"stages": "a", "stage_a_reset": "velocity"}, ["-stage_a_reset", "velocity", "displacement"]),
    "end of relaxations": ({"stages": ("a", "b"), "solve": "relax"}, ["-ts_max_steps", "every stage", "-relax_max_steps"]),
    "relaxation damped away": ({"solve": "relax", "ts_max_steps": DROP, "damping_local": 1.0}, ["-damping_local", "1"]),
    "relaxation ratio zero": ({"solve": "relax", "ts_max_steps": DROP, "relax_ratio": 0.0}, ["-relax_ratio", "0"]),
    "no such law": ({"block_law": "drucker"}, ["drucker", "drucker_prager", "elastic"]),
    # machine
    "unknown device": ({"device": "gpu"}, ["-device", "gpu", "cuda"]),
    "step above the bound": ({"ts_dt": 1.0}, ["-ts_dt", "bound", "-ts_central_check"]),
    "monitor that is no viewer": ({"monitor_energy": "printer"}, ["-monitor_energy printer", "ascii:FILE"]),
    "monitor into a folder that is not there": ({"monitor_energy": "ascii:no/energy.txt"}, ["no/energy.txt", "no folder"]),
    "format that no viewer has": ({"ts_view": "ascii:view.txt:fancy"}, ["-ts_view", "'fancy'"]),
    "TS's monitor that is no viewer": ({"ts_monitor": "x"}, ["-ts_monitor x"]),
    "partitioner that is not there": ({"petscpartitioner_type": "magic"}, ["-petscpartitioner_type", "magic"]),
    "type of stepping that PETSc has not": ({"ts_type": "foo"}, ["time stepper", "foo"]),
    "scale of the mesh that is no number": ({"dm_plex_scale": "x"}, ["meshes", "string x"]),
    "refinement that is no number": ({"dm_refine": "twice"}, ["-dm_refine", "twice"]),
    "refinement without end": ({"dm_refine": 30}, ["-dm_refine 30", "cells"]),
    "nonsense for all, though nobody needs it": ({"block_box_young": 1e9, "block_young": "x"}, ["-block_young", "'x'"]),
    "output is a file": ({"output": "scene.txt"}, ["scene.txt"]),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_option(name, tmp_path):
    changes, words = OPTIONS[name]
    assert_refused(tmp_path, changed(changes), words)


@pytest.mark.parametrize("name", ["misspelt option", "unknown surface", "no density", "nan", "step above the bound"])
def test_option_on_two_ranks(name, tmp_path):
    changes, words = OPTIONS[name]
    assert_refused(tmp_path, changed(changes), words, ranks=2)


def test_good_scene_is_accepted(tmp_path):
    """The scene that the cases above spoil has nothing wrong of its own."""
    for i, changes in enumerate(({}, JOINTS, DISCS, SPRINGS, {"block_element": "bbar", "mesh_box_shape": "wedge"})):
        done = harness.call(tmp_path / str(i), changed(changes))
        assert done.returncode == 0, text_of(done)
        assert (tmp_path / str(i) / "out" / "summary.json").exists()


def test_plastic_tetrahedra_are_noted(tmp_path):
    """Tetrahedra of form full lock in plastic flow: said where it is so, and only there."""
    tets = {**MOHR, "mesh_box_shape": "tet"}
    for i, (changes, locks) in enumerate(((tets, True), ({**tets, "block_element": "bbar"}, False),
                                          ({"mesh_box_shape": "tet"}, False), (MOHR, False))):
        done = harness.call(tmp_path / str(i), changed(changes))
        assert done.returncode == 0, text_of(done)
        assert ("lock in plastic flow" in text_of(done)) == locks, changes


# Meshes

CUBES = [(x, y, z) for z in (0, 1, 2) for y in (0, 1) for x in (0, 1)]
LOWER, UPPER = (1, 2, 4, 3, 5, 6, 8, 7), (5, 6, 8, 7, 9, 10, 12, 11)


def msh(nodes=CUBES, elements=((5, 1, LOWER), (5, 1, UPPER)), names=((3, 1, "rock"), (2, 7, "base")), tags=None):
    """Text of a 2.2 mesh; elements = [(gmsh type, physical tag, nodes)], numbered from 1 unless tags are given; the
    lowest face is surface `base`, the last element."""
    elements = list(elements) + [(3, 7, (1, 2, 4, 3))]
    tags = tags or range(1, len(elements) + 1)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{dim} {tag} "{name}"' for dim, tag, name in names]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate(nodes)]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{number} {kind} 2 {tag} {tag} " + " ".join(map(str, corners))
              for number, (kind, tag, corners) in zip(tags, elements)]
    return "\n".join(lines + ["$EndElements", ""])


TET10 = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, 0, 0), (.5, .5, 0), (0, .5, 0), (0, 0, .5), (0, .5, .5), (.5, 0, .5)]
INVERTED = (9, 10, 12, 11, 5, 6, 8, 7)
FLAT = (5, 6, 8, 7, 5, 6, 8, 7)
SQUASHED = CUBES[:8] + [(x, y, 1.0) for x, y, z in CUBES[8:]]
TWO = ((3, 1, "rock"), (3, 2, "cap"), (2, 7, "base"))
ON_MESH = {"mesh": "bad.msh", "mesh_box_cells": DROP, "mesh_box_size": DROP, "boundaries": "base",
           "boundary_zmin_fix": DROP, "boundary_base_fix": "xyz"}

MESHES = {
    "inverted element": (msh(elements=((5, 1, LOWER), (5, 1, INVERTED))), {}, ["bad.msh", "element", "2", "1.5"]),
    "element without volume": (msh(nodes=SQUASHED), {}, ["bad.msh", "element", "2"]),
    "element that uses a node twice": (msh(elements=((5, 1, LOWER), (5, 1, FLAT))), {}, ["bad.msh", "element", "2"]),
    "coordinates not finite": (msh(nodes=CUBES[:11] + [("nan", 1, 2)]), {}, ["bad.msh"]),
    "second order": (msh(nodes=TET10, elements=((11, 1, range(1, 11)),)), {}, ["bad.msh", "order"]),
    "surfaces only": (msh(elements=(), names=((2, 7, "base"),)), {}, ["bad.msh", "volume"]),
    "pyramid": (msh(elements=((5, 1, LOWER), (7, 1, (5, 6, 8, 7, 9)))), {}, ["bad.msh", "pyramid"]),
    "element of an unknown node": (msh(elements=((5, 1, LOWER), (5, 1, UPPER[:7] + (99,)))), {}, ["bad.msh", "99"]),
    "element twice": (msh(elements=((5, 1, LOWER), (5, 1, UPPER), (5, 1, UPPER))), {}, ["bad.msh", "element"]),
    "region without material": (msh(elements=((5, 1, LOWER), (5, 2, UPPER)), names=TWO),
                                {"block_young": DROP, "block_rock_young": 1e9}, ["cap", "young"]),
    "region without density": (msh(elements=((5, 1, LOWER), (5, 2, UPPER)), names=TWO),
                               {"block_density": DROP, "block_cap_density": 1e3}, ["rock", "density"]),
    "names that coincide": (msh(elements=((5, 1, LOWER), (5, 2, UPPER)),
                                names=((3, 1, "hard rock"), (3, 2, "hard_rock"), (2, 7, "base"))), {}, ["hard_rock"]),
    "truncated": (msh()[:-40], {}, ["bad.msh"]),
    "truncated in the nodes": (msh()[:150], {}, ["bad.msh"]),
    "empty": ("", {}, ["bad.msh"]),
    "not a mesh": ("solid cube\nfacet normal 0 0 1\n", {}, ["bad.msh"]),
    "missing": (None, {}, ["bad.msh"]),
    "quiet surface inside the body": (msh(elements=((5, 1, LOWER), (5, 1, UPPER), (3, 8, (5, 6, 8, 7))),
                                          names=((3, 1, "rock"), (2, 7, "base"), (2, 8, "middle"))),
                                      {"boundaries": ("base", "middle"), "boundary_middle_quiet": None},
                                      ["'middle'", "quiet", "inside the body", "outer boundary"]),
    "quiet line": (msh(elements=((5, 1, LOWER), (5, 1, UPPER), (1, 9, (1, 2))),
                       names=((3, 1, "rock"), (2, 7, "base"), (1, 9, "rim"))),
                   {"boundaries": ("base", "rim"), "boundary_rim_quiet": None}, ["'rim'", "quiet", "needs a surface"]),
}


def put(folder, text):
    folder.mkdir(parents=True, exist_ok=True)
    if text is not None:
        (folder / "bad.msh").write_text(text)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", MESHES)
def test_mesh(name, ranks, tmp_path):
    text, changes, words = MESHES[name]
    put(tmp_path, text)
    assert_refused(tmp_path, changed({**ON_MESH, **changes}), words, ranks=ranks)


def test_good_mesh_is_accepted(tmp_path):
    put(tmp_path, msh())
    done = harness.call(tmp_path, changed(ON_MESH))
    assert done.returncode == 0, text_of(done)


@pytest.mark.parametrize("held, said", [("z", False), ("xy", True)])
def test_weight_on_dashpots_is_said(held, said, tmp_path):
    done = harness.call(tmp_path, changed({"boundaries": ("zmin", "xmin"), "boundary_zmin_fix": DROP, "boundary_zmin_quiet": None,
                                           "boundary_xmin_fix": held}))
    assert done.returncode == 0, text_of(done)
    assert said == ("holds the weight along z" in text_of(done)), text_of(done)


def test_histories_without_a_folder_are_said(tmp_path):
    done = harness.call(tmp_path, changed({"output": DROP, "histories": "top", "history_top_at": (1, 1, 2),
                                           "history_top_of": "displacement_z"}))
    assert done.returncode == 0, text_of(done)
    assert [line for line in text_of(done).splitlines() if "histories" in line and "not recorded" in line], text_of(done)


def test_refused_run_leaves_monitor_files_alone(tmp_path):
    put(tmp_path, "precious")
    assert_refused(tmp_path, changed({"monitor_energy": "ascii:bad.msh", "gravty": 1}), ["-gravty", "-gravity"])
    assert (tmp_path / "bad.msh").read_text() == "precious"


def test_fix_and_velocity_of_one_component(tmp_path):
    assert_refused(tmp_path, changed({"boundary_zmin_velocity": (0, 0, 1)}), ["zmin", "velocity"])


def test_orphan_nodes_are_ignored_and_said(tmp_path):
    put(tmp_path, msh(nodes=CUBES + [(5, 5, 5), (6, 6, 6)]))
    done = harness.call(tmp_path, changed(ON_MESH))
    assert done.returncode == 0, text_of(done)
    said = [line for line in text_of(done).splitlines() if "bad.msh" in line and "2 nodes" in line and "ignored" in line]
    assert said, text_of(done)


# Joint files

DISC = "1 1 1 30 120 5\n"
JOINT_FILES = {
    "short line": (DISC + "# a comment\n1, 1, 1, 30, 120\n", ["-joint_j_file", "line 3 of bad.txt", "5 numbers", "x y z dip"]),
    "long line": (DISC + "1 1 1 30 120 5 6\n", ["line 2 of bad.txt", "7 numbers"]),
    "no number": (DISC + "1 1 one 30 120 5\n", ["line 2 of bad.txt", "'one'"]),
    "dip of 91": ("1 1 1 91 120 5\n", ["line 1 of bad.txt", "dip", "91"]),
    "diameter of 0": (DISC + DISC + "1 1 1 30 120 0\n", ["line 3 of bad.txt", "diameter"]),
    "empty": ("", ["bad.txt"]),
    "zero bytes": ("1 1 1 30 120 5\0\0\n", ["line 1 of bad.txt", "finite number"]),
    "comments only": ("# x y z\n", ["bad.txt", "x y z dip"]),
    "outside": ("9 9 9 0 0 1\n", ["bad.txt", "no disc", "'j'"]),
}


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", JOINT_FILES)
def test_joint_file(name, ranks, tmp_path):
    text, words = JOINT_FILES[name]
    (tmp_path / "bad.txt").write_text(text)
    assert_refused(tmp_path, changed({**DISCS, **FILE, "joint_j_file": "bad.txt"}), words, ranks=ranks)


def test_good_joint_file_is_accepted(tmp_path):
    (tmp_path / "good.txt").write_text(DISC + "9 9 9 0 0 1\n")
    done = harness.call(tmp_path, changed({**DISCS, **FILE, "joint_j_file": "good.txt"}))
    assert done.returncode == 0, text_of(done)
    assert "1 of 2 discs of good.txt lie outside" in text_of(done)


# Folders, machines, runs

def test_output_with_results_is_refused(tmp_path):
    assert harness.call(tmp_path, changed({})).returncode == 0
    before = files(tmp_path)
    assert_refused(tmp_path, changed({"ts_max_steps": 6}), ["out", "-output_overwrite"])
    after = files(tmp_path)
    for kept in (before, after):
        kept.pop("scene.txt")
    assert before == after


def test_output_overwrite(tmp_path):
    assert harness.call(tmp_path, changed({})).returncode == 0
    (tmp_path / "out" / "notes.txt").write_text("mine")
    done = harness.call(tmp_path, changed({"ts_max_steps": 6, "output_overwrite": None}))
    assert done.returncode == 0, text_of(done)
    assert harness.Results(tmp_path, "out", 0, "").summary["steps"] == 6
    assert (tmp_path / "out" / "notes.txt").read_text() == "mine"


def test_output_into_a_folder_that_holds_something_else(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    done = harness.call(tmp_path, changed({}))
    assert done.returncode == 0, text_of(done)
    assert (tmp_path / "out" / "notes.txt").read_text() == "mine"


def has_gpu():
    return shutil.which("nvidia-smi") is not None and subprocess.run(["nvidia-smi", "-L"], capture_output=True).returncode == 0


@pytest.mark.skipif(has_gpu(), reason="this machine has a GPU")
def test_cuda_without_gpu(tmp_path):
    assert_refused(tmp_path, changed({"device": "cuda"}), ["-device cuda"])


def test_step_above_the_bound_goes_on_when_told(tmp_path):
    for check in ("warn", "off"):
        done = harness.call(tmp_path / check, changed({"ts_dt": 1e-3, "ts_max_steps": 2, "ts_central_check": check}))
        assert done.returncode == 0, text_of(done)
        assert ("bound" in text_of(done)) == (check == "warn"), text_of(done)


def test_non_finite_run_stops_with_step_and_place(tmp_path):
    done = harness.call(tmp_path, changed({"ts_dt": 1e-2, "ts_max_steps": 5000, "ts_central_check": "off"}))
    text = text_of(done)
    assert done.returncode != 0, text[-2000:]
    message = text[text.index("cdem: error:"):].lower()
    for word in ("unstable", "in step", "node at ("):
        assert word in message, message


@pytest.mark.parametrize("mark", ["---", "...", "--- # more"])
def test_second_document_of_a_scene(mark, tmp_path):
    """PETSc reads the first document of a YAML file only."""
    rows = [f"{key}: {harness.as_text(value)}" for key, value in changed({}).items()]
    (tmp_path / "scene.yaml").write_text("\n".join(["# one", "---"] + rows[:4] + [mark] + rows[4:]) + "\n")
    done = subprocess.run([harness.program(), "-options_file", "scene.yaml"], cwd=tmp_path, env=harness.environment(),
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode == 1 and done.stderr.count("cdem: error:") == 1, text_of(done)
    assert "scene.yaml" in done.stderr, text_of(done)
    assert os.listdir(tmp_path) == ["scene.yaml"]


def test_quote_without_an_end(tmp_path):
    assert_refused(tmp_path, changed({"output": '"out'}), ["line", "scene.txt", "quote"])


def test_broken_yaml_names_its_file(tmp_path):
    (tmp_path / "scene.yaml").write_text("mesh: box\nblock: {young: 1.0e9\n")
    done = subprocess.run([harness.program(), "-options_file", "scene.yaml"], cwd=tmp_path, env=harness.environment(),
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode == 1 and done.stderr.count("cdem: error:") == 1 and "scene.yaml" in done.stderr, text_of(done)


def test_missing_options_file(tmp_path):
    done = subprocess.run([harness.program(), "-options_file", "nowhere.yaml"], cwd=tmp_path, env=harness.environment(),
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode != 0 and "nowhere.yaml" in text_of(done)
    assert os.listdir(tmp_path) == []


def test_help_lists_options_with_units(tmp_path):
    done = subprocess.run([harness.program(), "-help"], cwd=tmp_path, env=harness.environment(), text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode == 0, done.stderr[-2000:]
    units = {"young": "Pa", "density": "kg/m", "gravity": "m/s", "friction": "degree", "kn": "Pa/m", "cohesion": "Pa",
             "damping_alpha": "1/s", "damping_beta": "s", "table_<name>_frequency": "Hz", "mesh_box_size": "m",
             "boundary_<name>_pressure": "Pa", "ts_central_safety": "0.9"}
    lines = done.stdout.splitlines()
    for option, unit in units.items():
        found = [i for i, line in enumerate(lines) if line.lstrip().startswith("-") and option in line.split()[0]]
        assert found, f"-help does not list {option}"
        assert any(unit in " ".join(lines[i:i + 2]) for i in found), f"-help does not give {unit} for {option}"
    assert os.listdir(tmp_path) == []
