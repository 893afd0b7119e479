"""From a seed and a number to a case: the files of its folder, the command line, and what must come of it."""
import random
from dataclasses import dataclass, field

import numpy as np

import mesh_seeds
import mesh_truth
import mutate_mesh
import mutate_scene
import scene_seeds
import scene_text
import scene_truth

VELOCITY = (1e-3, 2e-3, 3e-3)


@dataclass
class Case:
    kind: str
    words: str  # what was done to it
    files: dict  # name -> bytes
    arguments: list = field(default_factory=lambda: ["-options_file", "scene.yaml"])
    ranks: int = 1
    good: bool = False  # must be accepted
    compare: object = None  # function of Results; raises when they are wrong


def mesh_case(rng):
    name, data, mesh, version, binary = mesh_seeds.seed(rng)
    boundary, interface = rng.choice(mesh_seeds.USES[name])
    words, good = "nothing", True
    if rng.random() > 0.03:
        data, words, good = mutate_mesh.mutate(rng, data, mesh, version, binary)
    lines = ["mesh: bad.msh", "block: {young: 1.0e9, poisson: 0.25, density: 2000}", f"boundaries: [{boundary}]",
             f"boundary_{boundary}_velocity: [{', '.join(map(str, VELOCITY))}]", "ts_max_steps: 2", "output: out"]
    if interface:
        lines += [f"interfaces: [{interface}]"]
    use = {"boundary": boundary, "interface": interface, "velocity": np.array(VELOCITY)}
    return Case(f"mesh {version}{'b' if binary else 'a'}", f"{name}: {words}",
                {"bad.msh": data, "scene.yaml": ("\n".join(lines) + "\n").encode()}, good=good,
                compare=lambda results: mesh_truth.compare(data, use, results))


def scene_case(rng):
    name = rng.choice(list(scene_seeds.SCENES))
    options, style = scene_seeds.SCENES[name], rng.choice(("yaml", "yaml", "opts"))
    rows, words, good = list(options.items()), "nothing", True
    way = rng.random()
    if 0.03 < way < 0.72:
        rows, words = mutate_scene.spoil_options(rng, options)
        good = False
    data = (scene_text.write_yaml if style == "yaml" else scene_text.write_lines)(rows, rng).encode()
    if way >= 0.72:
        data, words = mutate_scene.spoil_text(rng, data)
        good = False
    if style == "opts" and good:
        rng.shuffle(rows)
    file = f"scene.{style}"
    return Case(style, f"{name}: {words}", {file: data, **scene_seeds.files(options)}, ["-options_file", file], good=good,
                compare=lambda results: scene_truth.compare(data, style, results))


def rows_case(rng):
    name, file, judge = rng.choice([("path", "path.txt", scene_truth.compare_path), ("discs", "discs.txt", scene_truth.compare_discs)])
    options = scene_seeds.SCENES[name]
    data, words, good = scene_seeds.TEXTS[file], "nothing", True
    if rng.random() > 0.03:
        data, words = mutate_scene.spoil_rows(rng, data)
        good = False
    scene = scene_text.write_yaml(options.items(), rng).encode()
    return Case(f"{name} file", words, {"scene.yaml": scene, file: data}, good=good, compare=lambda results: judge(data, results))


KINDS = [(mesh_case, 50), (scene_case, 40), (rows_case, 10)]

def make(seed, number):
    """Case `number` of the series `seed`: the same on every machine, whichever cases run beside it."""
    rng = random.Random(f"cdem {seed} {number}")
    maker = rng.choices([kind for kind, _ in KINDS], [weight for _, weight in KINDS])[0]
    case = maker(rng)
    if rng.random() < 0.01:
        case.ranks = rng.choice((2, 3))
    return case
