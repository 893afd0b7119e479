"""Spoils meshes: their meaning (nodes, elements, groups), their text, their bytes."""
import random
import re
import struct

import msh

NUMBERS = ["0", "-1", "1", "2", "3", "7", "99", "4294967297", "2147483648", "-2147483649", "1e400", "1e-400", "1e308", "-1e200",
           "1e-320", "nan", "inf", "-inf", "abc", "1.5", "0x10", "1e", "--1", "+5", "1,5", "9223372036854775807",
           "9223372036854775808", "1000000000000", "$EndNodes", "\x00", "\xe9", "-0", ".", "2.2.2", "1e3"]


# Meaning. Each returns words that tell what it did; `good` ones must stay acceptable.

def _corner(rng, mesh):
    e = rng.choice(mesh.elements)
    k = rng.randrange(len(e.corners))
    value = rng.choice([0, -1, 10**6, 2**31 - 1, rng.choice(mesh.nodes)[0], e.corners[0], e.corners[-1]])
    e.corners = e.corners[:k] + (value,) + e.corners[k + 1:]
    return f"corner {k} of element {e.number} is {value}"


def _swap_corners(rng, mesh):
    e = rng.choice(mesh.elements)
    corners = list(e.corners)
    i, j = rng.randrange(len(corners)), rng.randrange(len(corners))
    corners[i], corners[j] = corners[j], corners[i]
    e.corners = tuple(corners)
    return f"corners {i} and {j} of element {e.number} change places"


def _twice(rng, mesh):
    e = rng.choice(mesh.elements)
    number = rng.choice([e.number, 1 + max(other.number for other in mesh.elements)])
    group = rng.choice([e.groups, (55,), ()])
    mesh.elements.insert(rng.randrange(len(mesh.elements) + 1), msh.Element(number, e.kind, group, e.corners))
    return f"element {e.number} a second time as {number} of {group}"


def _drop(rng, mesh):
    e = mesh.elements.pop(rng.randrange(len(mesh.elements)))
    return f"without element {e.number} of type {e.kind}"


def _kind(rng, mesh):
    e = rng.choice(mesh.elements)
    e.kind, old = rng.choice([k for k in msh.CORNERS if k != e.kind]), e.kind
    pool = [n for n, _ in mesh.nodes]
    e.corners = (e.corners + tuple(rng.choice(pool) for _ in range(8)))[:msh.CORNERS[e.kind]]
    return f"element {e.number} of type {e.kind} instead of {old}"


def _group(rng, mesh):
    e = rng.choice(mesh.elements)
    e.groups = rng.choice([(), (0,), (77,), (-1,), (2**31 - 1,), (1, 3), (7,), (1,), (3,), (5,)])
    return f"element {e.number} in groups {e.groups}"


def _name(rng, mesh):
    key = rng.choice(list(mesh.names) or [(3, 1)])
    old = mesh.names.get(key)
    mesh.names[key] = rng.choice(["", "a b", "base", "BASE", "rock:1", "depth", "x" * 5000, "-1", "a\"b", "\xe9t\xe9", "box", "all",
                                  "young", "celltype", "Cell Sets", "%s%n"])
    return f"group {key} is called {mesh.names[key][:20]!r} instead of {old!r}"


def _node(rng, mesh):
    i = rng.randrange(len(mesh.nodes))
    number, x = mesh.nodes[i]
    what = rng.choice(["drop", "number", "place", "far", "same", "nan"])
    if what == "drop":
        mesh.nodes.pop(i)
    elif what == "number":
        mesh.nodes[i] = (rng.choice([0, -5, 10**7, 2**31 - 1, mesh.nodes[0][0]]), x)
    else:
        new = list(x)
        new[rng.randrange(3)] = {"place": rng.uniform(-1, 2), "far": rng.choice([1e300, -1e155, 1e18]), "same": 0.0,
                                 "nan": float(rng.choice(["nan", "inf", "-inf"]))}[what]
        mesh.nodes[i] = (number, mesh.nodes[rng.randrange(len(mesh.nodes))][1] if what == "same" else tuple(new))
    return f"node {number}: {what}, now {mesh.nodes[i] if i < len(mesh.nodes) else None}"


def _tiny(rng, mesh):
    scale = rng.choice([1e-30, 1e-110, 1e30, 1e110, 0.0, -1.0])
    mesh.nodes = [(n, tuple(scale * c for c in x)) for n, x in mesh.nodes]
    return f"all coordinates times {scale}"


def _empty(rng, mesh):
    what = rng.choice(["nodes", "elements", "names"])
    setattr(mesh, what, {} if what == "names" else [])
    return f"no {what}"


def good_numbers(rng, mesh):
    """Other numbers of nodes and elements, other order: the same mesh."""
    names = [n for n, _ in mesh.nodes]
    new = dict(zip(names, rng.sample(range(1, 3 * len(names) + 1), len(names))))
    mesh.nodes = [(new[n], x) for n, x in mesh.nodes]
    rng.shuffle(mesh.nodes)
    offset = rng.choice([0, 100])
    for e in mesh.elements:
        e.corners = tuple(new[c] for c in e.corners)
        e.number += offset
    if rng.random() < 0.5:
        rng.shuffle(mesh.elements)
    return "nodes and elements numbered anew"


def good_place(rng, mesh):
    offset = [rng.uniform(-5, 5) for _ in range(3)]
    mesh.nodes = [(n, tuple(c + o for c, o in zip(x, offset))) for n, x in mesh.nodes]
    if rng.random() < 0.5:
        mesh.nodes.append((1 + max(n for n, _ in mesh.nodes), (9.0, 9.0, 9.0)))
    return "moved, perhaps with an orphan node"


MEANINGS = [_corner, _corner, _swap_corners, _swap_corners, _twice, _drop, _kind, _group, _name, _node, _node, _tiny, _empty]


# Text

def _lines(rng, data):
    lines = data.split(b"\n")
    what = rng.choice(["drop", "double", "swap", "cut", "blank", "join"])
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    if what == "drop":
        del lines[i]
    elif what == "double":
        lines.insert(i, lines[i])
    elif what == "swap":
        lines[i], lines[j] = lines[j], lines[i]
    elif what == "cut":
        lines[i] = lines[i][:rng.randrange(len(lines[i]) + 1)]
    elif what == "blank":
        lines.insert(i, b"")
    else:
        lines[i:i + 2] = [b" ".join(lines[i:i + 2])]
    return b"\n".join(lines), f"line {i + 1}: {what} ({j + 1})"


def _token(rng, data):
    spans = [m.span() for m in re.finditer(rb"[^\s]+", data)]
    if rng.random() < 0.4:  # the counts at the heads of sections
        heads = [m.span(1) for m in re.finditer(rb"\$(?:MeshFormat|Nodes|Elements|Entities|PhysicalNames)\n([^\n]*)", data)]
        spans = [s for s in spans if any(a <= s[0] < b for a, b in heads)] or spans
    a, b = rng.choice(spans)
    new = rng.choice(NUMBERS).encode("latin-1")
    if rng.random() < 0.2:
        c, d = rng.choice(spans)
        new = data[c:d]
    return data[:a] + new + data[b:], f"{data[a:b][:20]!r} at byte {a} becomes {new[:20]!r}"


def _sections(rng, data):
    parts = re.findall(rb"\$(\w+)\n(.*?)\$End\1[ \t]*\n", data, re.S)
    parts = [b"$%s\n%s$End%s\n" % (name, body, name) for name, body in parts]
    what = rng.choice(["order", "drop", "double", "name", "end"])
    i = rng.randrange(len(parts))
    if what == "order":
        rng.shuffle(parts)
    elif what == "drop":
        del parts[i]
    elif what == "double":
        parts.insert(rng.randrange(len(parts) + 1), parts[i])
    elif what == "name":
        parts[i] = re.sub(rb"^\$\w+", lambda m: rng.choice([m[0].lower(), m[0][:-1], b"$", b"$Junk", b"$ Nodes"]), parts[i])
    else:
        parts[i] = re.sub(rb"\$End\w+\n$", rng.choice([b"", b"$End\n", b"$EndNodes\n"]), parts[i])
    return b"".join(parts), f"section {i}: {what}"


def _truncate(rng, data):
    end = rng.randrange(len(data) + 1)
    return data[:end], f"the first {end} bytes"


def _bytes(rng, data):
    broken = bytearray(data)
    at = [rng.randrange(len(broken)) for _ in range(rng.choice([1, 1, 2, 5]))]
    for k in at:
        broken[k] = rng.choice([0, 255, 127, broken[k] ^ (1 << rng.randrange(8)), rng.randrange(256)])
    return bytes(broken), f"bytes {at} changed"


def _word(rng, data):
    """A whole number of a binary file."""
    code, value = rng.choice([("<i", rng.choice([0, -1, 2**31 - 1, -2**31, 4, 15, 100])),
                              ("<q", rng.choice([0, -1, 2**63 - 1, -2**63, 2**32, 2**40, 10**9])),
                              ("<d", float(rng.choice(["nan", "inf", "1e308", "0", "-1"])))])
    word = struct.pack(code, value)
    heads = [m.end() for m in re.finditer(rb"\$(?:Nodes|Elements|Entities|MeshFormat)\n", data)]
    at = rng.choice(heads) + 4 * rng.randrange(14) if heads and rng.random() < 0.6 else rng.randrange(len(data))
    return data[:at] + word + data[at + len(word):], f"{code} {value} at byte {at}"


def _insert(rng, data):
    at = rng.randrange(len(data) + 1)
    what = rng.choice([b"\n", b" ", b"\x00", b"$", b"0", b"-", b"\xff\xfe", b"$EndElements\n", bytes(8), b"x" * 3000])
    return data[:at] + what + data[at:], f"{what[:12]!r} put in at byte {at}"


def _header(rng, data):
    new = rng.choice([b"4.1 0 4", b"4.1 1 8", b"2.2 1 8", b"2.2 0 8", b"4.1 0 8", b"4 0 8", b"2 0 8", b"3 0 8", b"4.1 2 8", b"4.1 -1 8",
                      b"4.1 0 8 9", b"2.2e0 0 8", b"nan 0 8", b"4.1", b"", b"1e99 0 8", b"4.1000001 0 8", b"4.10 0 8", b"4.12 0 8"])
    return re.sub(rb"(?<=\$MeshFormat\n)[^\n]*", lambda m: new, data, count=1), f"header {new!r}"


def good_text(rng, data, binary):
    """Blank lines, comments, ends of lines that gmsh's own reader takes as well."""
    way = rng.random()
    if way < 0.3 and not binary:
        return data.replace(b"\n", b"\r\n"), "ends of lines of another system"
    if way < 0.6:
        at = rng.choice([b"$EndMeshFormat\n", b"$EndNodes\n"])
        return data.replace(at, at + b"$Comments\nmade by hand: $Nodes 4\n$EndComments\n"), "a comment"
    return data + rng.choice([b"\n\n", b"$Comments\nbehind\n$EndComments\n", b"$NodeData\n1\n\"T\"\n$EndNodeData\n"]), "something behind the end"


def mutate(rng: random.Random, data, mesh, version, binary):
    """(bytes, words, whether it must be accepted)."""
    way = rng.random()
    if mesh and way < 0.12:
        words = rng.choice([good_numbers, good_place])(rng, mesh)
        return msh.write(mesh, version, binary), words, True
    if way < 0.16:
        return *good_text(rng, data, binary), True
    if mesh and way < 0.55:
        words = "; ".join(rng.choice(MEANINGS)(rng, mesh) for _ in range(rng.choice([1, 1, 1, 2])) if mesh.elements and mesh.nodes)
        try:
            return msh.write(mesh, version, binary), words, False
        except struct.error:  # a number that this format cannot hold
            return msh.write(mesh, version, False), words, False
    ways = [_bytes, _word, _word, _truncate, _insert, _header] if binary else [
        _lines, _lines, _token, _token, _token, _sections, _truncate, _bytes, _insert, _header]
    data, words = rng.choice(ways)(rng, data)
    return data, words, False
