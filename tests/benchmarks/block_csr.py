"""The loop of block_csr.c by this machine's C compiler. Needs numpy and scipy."""
import ctypes
import subprocess
from pathlib import Path

import numpy as np

from measure import Failed

SOURCE = Path(__file__).resolve().with_suffix(".c")


def loop(folder):
    """Compiles into the folder. Returns run(blocks, steps, load, u, w, keep, which, drive), which changes u and w: blocks a
    bsr_matrix of 3x3 whose rows hold dt^2 over the mass, u the displacement and w its change in the last step."""
    library = Path(folder) / "block_csr.so"
    try:
        subprocess.run(["cc", "-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", "-o", library, SOURCE], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise Failed(f"no C compiler for the assembled stiffness: {error}") from error
    step = ctypes.CDLL(str(library)).steps

    def run(blocks, steps, load, u, w, keep=1.0, which=(), drive=()):
        arrays = [np.ascontiguousarray(a, t) for a, t in ((blocks.indptr, np.int32), (blocks.indices, np.int32), (blocks.data, float),
                                                          (load, float), (which, np.int32), (drive, float))]
        first, column, data, force, of, to = (ctypes.c_void_p(a.ctypes.data) for a in arrays)
        step(ctypes.c_long(len(u) // 3), ctypes.c_long(steps), ctypes.c_double(keep), first, column, data, force,
             ctypes.c_long(len(which)), of, to, ctypes.c_void_p(u.ctypes.data), ctypes.c_void_p(w.ctypes.data))

    return run
