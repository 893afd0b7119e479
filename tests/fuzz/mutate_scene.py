"""Spoils scenes: values, names and the text itself; tables and joint files line by line."""
import random
import re

import mutate_mesh
import scene_truth

VALUES = ["", "nan", "inf", "-inf", "-1", "0", "-0", "1", "2", "0.5", "0.7", "1e400", "1e-400", "1e308", "-1e308", "1e-308", "abc", "1,2",
          "1,2,3,4", "1,,3", ",", "1, 2, 3", "true", "false", "maybe", "0x10", "1.0.0", "1e", "--5", "1;2", "2147483648",
          "9223372036854775808", "1e10", "90", "89.95", "-1e-3", "x", "xyzz", "xx", "elastic", "box", "all", "between:box:box",
          "surface:", "joints:none", "inside:", ":::", "weibull:", "weibull:0", "weibull:-1", "normal:nan", "uniform:2", "fixed:0",
          "power:1,2", "lognormal:1,-1", "nowhere.txt", "/", ".", "scene.yaml", "\u00e9", "\u0661", "x" * 3000, "%s%n", "a b", "-x",
          "-young", "'", "$HOME", "~", "null", "1_000", "1 Pa", "\\n", "[1", "{", "1.5", "-3", "zmin", "zmin,zmin", "a,b"]
# Not by value: what would only take long, or much memory, is no bad input.
OUTPUT = ["", ".", "path.txt", "out/x/y", "scene.yaml", "OUT", "a b", "\u00e9", "true", "-x", "x" * 300]
SLOW = {"output": OUTPUT, "ts_max_steps": ["0", "-1", "1e1", "2.5", "nan", "abc", "", "5", "3,4", "99999999999999999999", "1e400"],
        "dm_refine": ["0", "1", "-1", "30", "x", "1.5", "", "1e9"], "ts_max_time": ["0", "-1", "nan", "abc", "", "1e-3", "inf", "1,2", "1e-300"],
        "mesh_box_cells": ["0,1,1", "-1,2,2", "1,1,1", "1,2", "2,2,2,2", "a,b,c", "1.5,2,2", "1e1,1,1", "nan,1,1", "1e9,1e9,1e9",
                           "2147483648,1,1", "100000,100000,100000", "2147483647,1,1", "", "1 1 1"],
        "p32": ["0", "-1", "nan", "1e10", "1e300", "", "1e-9", "3", "abc"], "count": ["0", "-1", "nan", "1e10", "1e300", "", "1e-9", "3"],
        "diameter": ["fixed:0", "fixed:-1", "fixed:2", "fixed:nan", "power:2.5,1", "power:0,1,2", "power:1,1,2", "uniform:2,1",
                     "uniform:1,2", "lognormal:1,0", "lognormal:1,1e3", "gamma:1", "", "fixed:1e300", "2"]}


def value_of(rng, name, old):
    for key, values in SLOW.items():
        if name == key or name.endswith("_" + key):
            return rng.choice(values)
    return rng.choice(VALUES + ["-" + old, old + ",1", old + "x", old.upper(), " " + old, old + "e3", old[:-1]] * 2)


def spoil_options(rng, options):
    """[(name, value)] of a dict, spoilt; and words."""
    rows = list(options.items())
    i = rng.randrange(len(rows))
    name, old = rows[i]
    what = rng.choices(["value", "drop", "name", "double", "other", "case", "order"], [50, 10, 12, 8, 12, 4, 4])[0]
    if what == "value":
        rows[i] = (name, value_of(rng, name, old))
    elif what == "drop":
        del rows[i]
    elif what == "name":
        at = rng.randrange(len(name))
        new = rng.choice([name[:at] + name[at + 1:], name[:at] + rng.choice("aexz_-.0") + name[at:], name + "_x", "x" + name, name[:-1]])
        rows[i] = (new, old)
    elif what == "double":
        rows.insert(rng.randrange(len(rows) + 1), (name, value_of(rng, name, old)))
    elif what == "other":  # an option from anywhere in the language
        pattern, _ = rng.choice(scene_truth.PATTERNS)
        new = pattern.pattern.replace("(_.+)?", rng.choice(["", "_box", "_i", "_zmin", "_none"]))
        if new not in ("help_options", "log_view", "options_file"):
            rows.insert(rng.randrange(len(rows) + 1), (new, value_of(rng, new, rng.choice(VALUES))))
    elif what == "case":
        rows[i] = (name.upper(), old)
    else:
        rng.shuffle(rows)
    return rows, f"{what} of {name}: {[row for row in rows if row not in options.items()]}"[:300]


def spoil_text(rng, data):
    """Bytes of a scene, spoilt as a text."""
    lines = data.split(b"\n")
    i = rng.randrange(len(lines))
    what = rng.choice(["drop", "double", "indent", "tab", "colon", "bytes", "cut", "put", "swap", "empty", "documents", "bom"])
    if what == "drop":
        del lines[i]
    elif what == "double":
        lines.insert(rng.randrange(len(lines)), lines[i])
    elif what == "indent":
        lines[i] = rng.choice([b" ", b"   ", b"        "]) + lines[i]
    elif what == "tab":
        lines[i] = b"\t" + lines[i].strip()
    elif what == "colon":
        lines[i] = lines[i].replace(b":", rng.choice([b"", b" ", b":", b" : : "]), 1)
    elif what == "swap":
        j = rng.randrange(len(lines))
        lines[i], lines[j] = lines[j], lines[i]
    elif what == "documents":
        lines.insert(i, rng.choice([b"---", b"...", b"%YAML 1.1", b"- a", b"? a", b"&a", b"*a", b"<<: *a", b"!!int 3", b"key: &x 1"]))
    data = b"\n".join(lines)
    if what == "bytes":
        return mutate_mesh._bytes(rng, data)[0], what
    if what == "cut":
        return data[:rng.randrange(len(data) + 1)], what
    if what == "put":
        at = rng.randrange(len(data))
        new = rng.choice([b"\xff", b"\x00", b"[", b"]", b"{", b"}", b"'", b'"', b"#", b"\xc3\xa9", b"|", b">", b"%", b"@", b"`", b"\r",
                          b",", b" - ", b"\x1b[31m", b"-", b"\\"])
        return data[:at] + new + data[at:], f"{new!r} at byte {at}"
    if what == "empty":
        return rng.choice([b"", b"\n", b"# nothing\n", b"\x00", b"null\n", b"just words\n", b"-\n"]), what
    if what == "bom":
        return rng.choice([b"\xef\xbb\xbf", b"\xff\xfe"]) + data, what
    return data, f"{what} in line {i + 1}"


def spoil_rows(rng: random.Random, data):
    """Bytes of a table or joint file, spoilt."""
    way = rng.choice([mutate_mesh._lines, mutate_mesh._token, mutate_mesh._token, mutate_mesh._bytes, mutate_mesh._truncate,
                      mutate_mesh._insert, _number])
    return way(rng, data)


def _number(rng, data):
    spans = [m.span() for m in re.finditer(rb"(?<![#\w.])[-\d.e]+(?=[\s,])", data)]
    a, b = rng.choice(spans)
    new = rng.choice([b"-1", b"0", b"91", b"361", b"1e300", b"1e-300", b"1e-4", b"90", b"0.1", b"nan", b"1e5", b"+3", b"1,2", b"1;2"])
    return data[:a] + new + data[b:], f"{data[a:b]!r} at byte {a} becomes {new!r}"
