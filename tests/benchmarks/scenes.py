"""Scenes that several benchmarks run."""

ROCK = {"young": 1.0e10, "poisson": 0.25, "density": 2500.0}


def weight(base, steps):
    """Rock on a held base, under its weight."""
    return {**{f"block_{key}": value for key, value in ROCK.items()}, "gravity": "0,0,-9.81", "boundaries": base,
            f"boundary_{base}_fix": "xyz", "ts_max_steps": steps, "output_fields": "region"}


def box(cells, steps, **more):
    """A box of cells of 1 m."""
    return {"mesh": "box", "mesh_box_cells": ",".join(map(str, cells)), "mesh_box_size": ",".join(map(str, cells)),
            **weight("zmin", steps), **more}


def filed(mesh, steps):
    """The mesh of box.geo from its file."""
    return {"mesh": mesh, **weight("base", steps)}


def springs(law):
    """Every face an interface; the brittle ones test their strength in every step and never reach it."""
    strength = {"tension": 1e15, "cohesion": 1e15, "friction": 30} if law == "brittle" else {}
    return {"interfaces": "all", "interface_all_on": "all", "interface_all_law": law,
            **{f"interface_all_{key}": value for key, value in strength.items()}}
