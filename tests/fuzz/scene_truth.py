"""What a scene says, read here from its text, against scene.opts and the results of the run that accepted it."""
import math
import re
from pathlib import Path

import scene_text
from mesh_truth import Wrong, demand

PAGE = Path(__file__).resolve().parents[2] / "docs" / "options.md"
REAL = r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?0[xX][\da-fA-F]+"


def between(low, high, left="[", right="]"):
    def check(x):
        return (x > low or (left == "[" and x == low)) and (x < high or (right == "]" and x == high))
    return check


ABOVE_0, FROM_0 = between(0, math.inf, "(", ")"), between(0, math.inf, "[", ")")
RANGES = (  # the first that fits a name holds for all numbers of its value
    (r"poisson$", between(-1, 0.5, "(", ")")), (r"block_.*friction$|interface_.*friction$|_dilation$", between(0, 89.9)),
    (r"(young|density|kn|ks|stiffness_factor|gi|gii|gf|dilation_slip|scatter_volume|p32|count|frequency)$", ABOVE_0),
    (r"block_.*(cohesion|tension)$|interface_.*(cohesion|tension)$", FROM_0), (r"_dip$", between(0, 90)),
    (r"dip_direction$", between(0, 360)), (r"fisher$|damping_(alpha|beta)$", FROM_0), (r"mesh_box_cells$", between(1, 1e9)),
    (r"mesh_box_size$|ts_max_time$|ts_dt$|_interval_time$", ABOVE_0), (r"mesh_box_jitter$", between(0, 0.5, "[", ")")),
    (r"ts_max_steps$", FROM_0), (r"ts_central_safety$", between(0, 1, "(", "]")),
    (r"ts_central_batch$|_interval$", between(1, math.inf)))


def patterns():
    """[(regular expression of a name, kind of value)] of the options page."""
    rows = re.findall(r"^\| `-([^`]+)` \| ([^|]+) \|", PAGE.read_text(), re.M)
    found = []
    for name, kind in rows:
        family = re.fullmatch(r"(\w+)_<\w+>_?(\w*)", name)
        if family:  # for all, or by name
            key = "_" + family.group(2) if family.group(2) else ""
            found.append((f"{family.group(1)}(_.+)?{key}", kind))
        else:
            found.append((name, kind))
    return sorted(((re.compile(p, re.I), k) for p, k in found), key=lambda row: -len(row[0].pattern))


PATTERNS = patterns()


def number(text):
    demand(re.fullmatch(REAL, text), f"accepted '{text}' for a number")
    value = float.fromhex(text) if "x" in text.lower() else float(text)
    demand(math.isfinite(value), f"accepted the number {text}")
    return value


def check_value(name, value):
    """Raises Wrong where a value could not be accepted."""
    kinds = [kind for pattern, kind in PATTERNS if pattern.fullmatch(name)]
    demand(kinds, f"accepted the option -{name}, which is not on the options page")
    kind, text = kinds[0], value or ""
    words = [w.strip() for w in text.split(",")]
    if kind.startswith("true"):
        demand(text.lower() in ("", "true", "false", "yes", "no", "on", "off", "0", "1"), f"accepted -{name} {text}")
    elif kind.startswith("one of"):
        demand(text in re.sub(r"\[.*?\]", "", kind[7:]).split(", "), f"accepted -{name} {text}")
    elif kind.startswith(("a number", "an integer", "3 ")):
        demand(len(words) == (3 if kind[0] == "3" else 1), f"accepted -{name} {text}")
        numbers = [number(w) for w in words]
        whole = kind.startswith("an integer") or "integers" in kind
        demand(not whole or all(x == int(x) and abs(x) < 2**63 for x in numbers), f"accepted -{name} {text}")
        for pattern, good in RANGES:
            if re.search(pattern, name.lower()):
                demand(all(map(good, numbers)), f"accepted -{name} {text}, out of its range")
                break


def read(data, style):
    try:
        return {name.lower(): value for name, value in (scene_text.read_yaml if style == "yaml" else scene_text.read_lines)(data)}
    except scene_text.Unreadable as error:
        raise Wrong(f"accepted a scene that cannot be read: {error}")


def same(name, said, meant):
    if name == "ts_max_steps":
        return float(said) == number(meant)
    return (said or "") == (meant or "")


def compare(data, style, results):
    """Raises Wrong unless the run has taken the scene as it stands."""
    meant = read(data, style)
    said = {name.lower(): value for name, value in scene_text.read_lines(results.scene().encode(errors="surrogateescape"))}
    for name, value in meant.items():
        check_value(name, value)
        demand(name in said or re.search(r"[\"#\t\r\n]|^-[A-Za-z]", value or ""), f"scene.opts does not hold -{name}")
        demand(name not in said or same(name, said[name], value), f"-{name} is '{value}' in the scene and '{said.get(name)}' in scene.opts")
    extra = set(said) - set(meant)
    demand(not extra, f"scene.opts holds {extra}, which nobody gave")
    summary = results.summary
    if meant["mesh"] == "box":
        cells = math.prod(int(number(w)) for w in meant["mesh_box_cells"].split(","))
        shape = meant.get("mesh_box_shape") or "hex"
        wanted = {"hex": {"hex8": cells}, "tet": {"tet4": 6 * cells}, "wedge": {"wedge6": 2 * cells}}[shape]
        demand(summary["elements"] == wanted, f"elements {summary['elements']} instead of {wanted}")
    steps = int(number(meant["ts_max_steps"])) if meant.get("ts_max_steps") else None
    if steps is not None:
        demand(summary["steps"] == steps if "ts_max_time" not in meant else summary["steps"] <= steps, f"{summary['steps']} steps")
    if meant.get("ts_dt") and "ts_max_time" not in meant:
        demand(summary["dt"] == number(meant["ts_dt"]), f"dt {summary['dt']}")
    if meant.get("ts_max_time") and steps is None:
        demand(abs(summary["time"] - number(meant["ts_max_time"])) <= 1e-9 * summary["time"], f"time {summary['time']}")


# Tables and discs

def rows_of(data, columns):
    """Lines of so many numbers, as the options page describes the files."""
    rows = []
    for line in data.decode("latin-1").split("\n"):
        words = line.split("#")[0].replace(",", " ").split()
        if words:
            demand(len(words) == columns, f"accepted the line {line[:60]!r}")
            rows.append([number(word) for word in words])
    demand(rows, "accepted a file without a line")
    return rows


def compare_path(data, results):
    """The history of a node that follows the table, times 1e-6."""
    rows = rows_of(data, 2)
    demand(all(a[0] < b[0] for a, b in zip(rows, rows[1:])), "accepted times that do not ascend")
    _, lines = results.columns("histories.csv")
    for step, time, value in ((int(s), float(t), float(v)) for s, t, v in lines):
        i = sum(row[0] <= time for row in rows)
        if i in (0, len(rows)):
            wanted = rows[min(i, len(rows) - 1)][1]
        else:
            (t0, v0), (t1, v1) = rows[i - 1], rows[i]
            wanted = v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
        scale = max(abs(row[1]) for row in rows)
        demand(step == 0 or abs(value - 1e-6 * wanted) <= 1e-12 * 1e-6 * scale, f"displacement {value} in step {step}, not 1e-6 * {wanted}")


def compare_discs(data, results):
    rows = rows_of(data, 6)
    for row in rows:
        demand(0 <= row[3] <= 90 and 0 <= row[4] <= 360 and row[5] > 0, f"accepted the disc {row}")
    outside = re.search(r"(\d+) of (\d+) discs of discs.txt lie outside", results.text)
    header, lines = results.columns("joints.csv")
    demand(len(lines) + (int(outside.group(1)) if outside else 0) == len(rows), f"{len(lines)} discs of {len(rows)}")
    given = [row[:3] + row[5:] for row in rows]
    for line in lines:
        values = dict(zip(header, line))
        disc = [float(values[key]) for key in ("x", "y", "z", "diameter")]
        demand(any(all(math.isclose(a, b, rel_tol=1e-15) for a, b in zip(disc, row)) for row in given), f"a disc {disc} that nobody gave")
