"""gmsh files of format 2.2 and 4.1, ASCII and binary: read and written here without anything of cdem or gmsh.

The reader takes every number of the file by the letter of the format and raises Unreadable otherwise: what the program
accepts must be readable here, and must mean the same."""
import re
import struct
from dataclasses import dataclass, field

CORNERS = {15: 1, 1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6}
DIMENSION = {15: 0, 1: 1, 2: 2, 3: 2, 4: 3, 5: 3, 6: 3}


class Unreadable(Exception):
    """The file is not what the format says."""


@dataclass
class Element:
    number: int
    kind: int
    groups: tuple  # tags of physical groups
    corners: tuple  # numbers of nodes


@dataclass
class Msh:
    names: dict = field(default_factory=dict)  # (dimension, tag) -> name
    nodes: list = field(default_factory=list)  # (number, (x, y, z))
    elements: list = field(default_factory=list)


class _Tokens:
    """The numbers of a section, as text or in binary."""

    def __init__(self, data, binary):
        self.data, self.binary, self.at = data, binary, 0
        self.words = None if binary else data.split()

    def _raw(self, code):
        size = struct.calcsize(code)
        if self.at + size > len(self.data):
            raise Unreadable("section too short")
        self.at += size
        return struct.unpack(code, self.data[self.at - size:self.at])[0]

    def _word(self):
        if self.at >= len(self.words):
            raise Unreadable("section too short")
        self.at += 1
        return self.words[self.at - 1]

    def int(self, code="<i"):
        if self.binary:
            return self._raw(code)
        word = self._word()
        if not re.fullmatch(rb"[+-]?\d+", word):
            raise Unreadable(f"no integer: {word[:20]}")
        return int(word)

    def size(self):
        return self.int("<q")

    def real(self):
        if self.binary:
            return self._raw("<d")
        word = self._word()
        if not re.fullmatch(rb"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", word):
            raise Unreadable(f"no number: {word[:20]}")
        return float(word)

    def line_int(self):
        """A count on a line of its own, text in binary files too."""
        if not self.binary:
            return self.int()
        end = self.data.find(b"\n", self.at)
        text = self.data[self.at:end].strip()
        if end < 0 or not re.fullmatch(rb"\d+", text):
            raise Unreadable("no count")
        self.at = end + 1
        return int(text)

    def end(self):
        rest = self.data[self.at:].strip() if self.binary else self.words[self.at:]
        if rest:
            raise Unreadable(f"section too long: {rest[:3]}")


def _sections(data):
    """Bodies of the sections by name, up to $Elements; a section begins and ends on lines of its own."""
    found = {}
    at = 0
    while "Elements" not in found:
        begin = re.compile(rb"\s*\$(\w+)[ \t]*\r?\n").match(data, at)
        if not begin:
            raise Unreadable("no section where one is expected")
        name = begin.group(1).decode()
        end = re.compile(rb"(?:^|\n|(?<=\n))?\$End" + begin.group(1) + rb"[ \t]*\r?(\n|$)").search(data, begin.end())
        if not end:
            raise Unreadable(f"${name} does not end")
        if name in found:
            raise Unreadable(f"${name} twice")
        found[name] = data[begin.end():end.start()]
        at = end.end()
    return found


def read(data):
    """Msh of the bytes of a file; raises Unreadable."""
    parts = _sections(data)
    head = parts.get("MeshFormat", b"").split(b"\n", 1)
    words = head[0].split()
    if next(iter(parts)) != "MeshFormat" or len(words) != 3 or not re.fullmatch(rb"\d\.\d+(e0)?", words[0]):
        raise Unreadable("header")
    if float(words[0]) not in (2.2, 4.1):
        raise Unreadable("version")
    if words[1] not in (b"0", b"1", b"-0", b"+0") or words[2] != b"8" or "Nodes" not in parts:
        raise Unreadable("header")
    binary, new = words[1] == b"1", words[0][:1] == b"4"
    if binary and (len(head) < 2 or head[1][:4] != struct.pack("<i", 1)):
        raise Unreadable("byte order")
    mesh = Msh(names=_names(parts.get("PhysicalNames")))
    if list(parts).index("Nodes") > list(parts).index("Elements"):
        raise Unreadable("order of sections")
    sections = {key: _Tokens(body, binary) for key, body in parts.items()}
    if new:
        groups = _entities(sections["Entities"]) if "Entities" in sections else {}
        _nodes41(sections["Nodes"], mesh)
        _elements41(sections["Elements"], mesh, groups)
    else:
        _nodes22(sections["Nodes"], mesh)
        _elements22(sections["Elements"], mesh)
    for key in ("Nodes", "Elements"):
        sections[key].end()
    return mesh


def _names(body):
    if body is None:
        return {}
    lines = body.decode("latin-1").strip().splitlines()
    names = {}
    if not lines or not lines[0].strip().isdigit() or int(lines[0]) != len(lines) - 1:
        raise Unreadable("count of physical names")
    for line in lines[1:]:
        match = re.fullmatch(r'\s*(\d+)\s+(-?\d+)\s+"(.*)"\s*', line)
        if not match:
            raise Unreadable("physical name")
        names[int(match.group(1)), abs(int(match.group(2)))] = match.group(3)
    return names


def _entities(tokens):
    groups = {}
    for dim, count in enumerate([tokens.size() for _ in range(4)]):
        for _ in range(count):
            entity = tokens.int()
            for _ in range(3 if dim == 0 else 6):
                tokens.real()
            groups[dim, entity] = tuple(abs(tokens.int()) for _ in range(tokens.size()))
            if dim > 0:
                for _ in range(tokens.size()):
                    tokens.int()
    tokens.end()
    return groups


def _nodes22(tokens, mesh):
    for _ in range(tokens.line_int()):
        number = tokens.int()
        mesh.nodes.append((number, tuple(tokens.real() for _ in range(3))))


def _nodes41(tokens, mesh):
    blocks, total = tokens.size(), tokens.size()
    tokens.size(), tokens.size()
    for _ in range(blocks):
        tokens.int(), tokens.int()
        if tokens.int() != 0:
            raise Unreadable("parametric")
        numbers = [tokens.size() for _ in range(tokens.size())]
        mesh.nodes += [(number, tuple(tokens.real() for _ in range(3))) for number in numbers]
    if len(mesh.nodes) != total:
        raise Unreadable("count of nodes")


def _elements22(tokens, mesh):
    count = tokens.line_int()
    while len(mesh.elements) < count:
        number, block = (None, None) if tokens.binary else (tokens.int(), 1)
        kind = tokens.int()
        if tokens.binary:
            block = tokens.int()
        n_tags = tokens.int()
        if kind not in CORNERS or block < 1 or n_tags < 0:
            raise Unreadable("element")
        for _ in range(block):
            if tokens.binary:
                number = tokens.int()
            tags = [tokens.int() for _ in range(n_tags)]
            group = (abs(tags[0]),) if tags and tags[0] else ()
            mesh.elements.append(Element(number, kind, group, tuple(tokens.int() for _ in range(CORNERS[kind]))))
    if len(mesh.elements) != count:
        raise Unreadable("count of elements")


def _elements41(tokens, mesh, groups):
    blocks, total = tokens.size(), tokens.size()
    tokens.size(), tokens.size()
    for _ in range(blocks):
        dim, entity, kind = tokens.int(), tokens.int(), tokens.int()
        if kind not in CORNERS or DIMENSION[kind] != dim:
            raise Unreadable("element")
        for _ in range(tokens.size()):
            number = tokens.size()
            corners = tuple(tokens.size() for _ in range(CORNERS[kind]))
            mesh.elements.append(Element(number, kind, groups.get((dim, entity), ()), corners))
    if len(mesh.elements) != total:
        raise Unreadable("count of elements")


# Writing

def _pack(binary, code, values):
    return struct.pack(f"<{len(values)}{code}", *values) if binary else (" ".join(map(repr, values)) + "\n").encode()


def write(mesh, version, binary):
    """Bytes of the file; version is 22 or 41."""
    out = [b"$MeshFormat\n%s %d 8\n" % (b"2.2" if version == 22 else b"4.1", binary)]
    out += [struct.pack("<i", 1) + b"\n"] if binary else []
    out += [b"$EndMeshFormat\n"]
    if mesh.names:
        out += [b"$PhysicalNames\n%d\n" % len(mesh.names)]
        out += [f'{dim} {tag} "{name}"\n'.encode() for (dim, tag), name in mesh.names.items()] + [b"$EndPhysicalNames\n"]
    body = _body22 if version == 22 else _body41
    return b"".join(out + body(mesh, binary))


def _body22(mesh, binary):
    out = [b"$Nodes\n%d\n" % len(mesh.nodes)]
    for number, x in mesh.nodes:
        out += [struct.pack("<i3d", number, *x) if binary else ("%d %r %r %r\n" % (number, *x)).encode()]
    out += [b"\n" * binary + b"$EndNodes\n$Elements\n%d\n" % len(mesh.elements)]
    for e in mesh.elements:
        group = e.groups[0] if e.groups else 0
        head = (e.kind, 1, 2, e.number) if binary else (e.number, e.kind, 2)
        out += [_pack(binary, "i", (*head, group, group or 1, *e.corners))]
    return out + [b"\n" * binary + b"$EndElements\n"]


def _body41(mesh, binary):
    entities = {}  # (dimension, groups) -> number
    blocks = []  # (dimension, entity, kind), elements
    for e in mesh.elements:
        key = DIMENSION[e.kind], e.groups
        entity = entities.setdefault(key, 1 + sum(dim == key[0] for dim, _ in entities))
        head = (key[0], entity, e.kind)
        if not blocks or blocks[-1][0] != head:
            blocks.append((head, []))
        blocks[-1][1].append(e)
    out = [b"$Entities\n", _pack(binary, "q", [sum(d == dim for d, _ in entities) for dim in range(4)])]
    for dim in range(4):
        for (d, groups), entity in entities.items():
            if d != dim:
                continue
            out += [_pack(binary, "i", (entity,)), _pack(binary, "d", (0.0,) * (3 if dim == 0 else 6))]
            out += [_pack(binary, "q", (len(groups),)), _pack(binary, "i", groups) if groups else b""]
            out += [_pack(binary, "q", (0,))] if dim else []
    numbers = [number for number, _ in mesh.nodes] or [0]
    out += [b"\n" * binary + b"$EndEntities\n$Nodes\n"]
    out += [_pack(binary, "q", (1, len(mesh.nodes), min(numbers), max(numbers))), _pack(binary, "i", (3, 1, 0))]
    out += [_pack(binary, "q", (len(mesh.nodes),))] + [_pack(binary, "q", (number,)) for number, _ in mesh.nodes]
    out += [_pack(binary, "d", x) for _, x in mesh.nodes]
    out += [b"\n" * binary + b"$EndNodes\n$Elements\n"]
    numbers = [e.number for e in mesh.elements] or [0]
    out += [_pack(binary, "q", (len(blocks), len(mesh.elements), min(numbers), max(numbers)))]
    for head, elements in blocks:
        out += [_pack(binary, "i", head), _pack(binary, "q", (len(elements),))]
        out += [_pack(binary, "q", (e.number, *e.corners)) for e in elements]
    return out + [b"\n" * binary + b"$EndElements\n"]
