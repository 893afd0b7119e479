"""The peers beside the program: the assembled stiffness as a matrix of PETSc within it (-central_way assembled), on the CPU
loops of scipy and C over such a matrix too (peer.py), on the GPU PyTorch (peer_torch.py). Python's standard library only; what
the others need is looked for in the Pythons of this machine."""
import json
import shutil
from pathlib import Path

from measure import Failed, median_of, middle, used
from outside import python, python_with

DIFFERENCE = """import sys
from outside import last_frame
ours, theirs = (last_frame(folder)[2] for folder in sys.argv[1:])
print(abs(ours - theirs).max() / abs(theirs).max())"""
HERE = Path(__file__).resolve().parent


def scenes(device, quick, box):
    """(name, title, options) of what the peers run; box: makes a scene."""
    def of(n, steps, **more):
        n = min(n, 12) if quick else n
        return box((n, n, n), max(2, steps // 20) if quick else steps, **more)

    jitter, given = {"mesh_box_jitter": 0.1}, {"ts_dt": 2.5e-4, "ts_central_check": "off"}
    brick = ("brick_bare", "brick without histories", of(10, 8000))
    if device == "cpu":
        return [brick, ("hex_27000", "27,000 general hexahedra", of(30, 300, **jitter)),
                ("hex", "64,000 general hexahedra", of(40, 200, **jitter))]
    return [brick, ("box_39304", "39,304 regular hexahedra", of(34, 4000)),
            ("hex_39304", "39,304 general hexahedra", of(34, 4000, **jitter)),
            ("box_1000000", "1,000,000 regular hexahedra", of(100, 640, **given)),
            ("hex_1000000", "1,000,000 general hexahedra", of(100, 640, **jitter, **given))]


def form(name, runs, work):
    """A row of the table."""
    solve, spread = middle(used(runs, "solve"))
    row = {"form": name, "solve": solve, "spread": spread, "ns": solve / work * 1e9, "runs": runs,
           "fastest_ns": min(used(runs, "solve")) / work * 1e9, "share": min(used(runs, "share"))}
    if "difference" in runs[0]:
        row["difference"] = max(r["difference"] for r in runs)
    return row


def measure(machine, name, title, options, rock, repeat, summary_of):
    """The peers on a scene and against the end state of one run of ours; ours runs again before and after them."""
    cuda, n = machine.device == "cuda", min(repeat, 3)
    reader = python_with("numpy", "h5py")
    outsider = python_with("numpy", "h5py", "torch" if cuda else "scipy")
    missing = [] if outsider else [f"no Python here has numpy, h5py and {'torch with CUDA' if cuda else 'scipy'}"]

    def ours(more):
        return median_of(lambda: machine.run({**options, **more}), n, cuda, not cuda)

    own = ours({})
    summary = machine.run({**options, "output_fields": "displacement"}, keep=True)["summary"]
    work = sum(summary["elements"].values()) * summary["steps"]
    theirs = machine.scratch / "theirs"
    shutil.rmtree(theirs, ignore_errors=True)
    shutil.copytree(machine.out, theirs)
    assembled = {"central_way": "assembled"}
    within = ours(assembled)
    summary_of(within)
    if reader:
        machine.run({**options, **assembled, "output_fields": "displacement"}, keep=True)
        difference = float(python(reader, "-c", DIFFERENCE, machine.out, theirs))
        for run in within:
            run["difference"] = difference
    forms = [form(f"cdem -central_way assembled (PETSc, {'seqaijcusparse' if cuda else 'seqbaij'})", within, work)]
    version = f"set-up of the matrix within cdem: {min(r['setup_device'] for r in within):.3g} s"
    if outsider:
        scene = {**rock, "gravity": (0, 0, -9.81), "dt": summary["dt"], "steps": summary["steps"]}
        try:
            words = [HERE / ("peer_torch.py" if cuda else "peer.py"), theirs, json.dumps(scene), str(n)]
            result = json.loads(python(outsider, *words))
            forms += [form(name, runs, work) for name, runs in result["forms"].items()]
            version += f"; {result['version']}"
        except Failed as error:  # the others count
            missing.append(str(error))
    own += ours({})
    summary_of(own)
    forms.append(form("cdem", own, work))
    return {"name": f"peer_{name}", "of": title, "version": version, "missing": missing, "forms": forms}
