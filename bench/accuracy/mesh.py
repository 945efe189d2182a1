# SPDX-License-Identifier: Apache-2.0
"""Meshes for the accuracy sets: read from PLY, cut, and written as PLY. Plain Python, no packages."""

import math
import os
import random
import struct

SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f",
         "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
         "float32": "f", "float64": "d"}


def border_ends(faces):
    """The ends of the half-edges without an opposite one, by their beginnings."""
    edges = {edge for face in faces for edge in zip(face, face[1:] + face[:1])}
    ends = {}
    for a, b in sorted(edges):
        if (b, a) not in edges:
            ends.setdefault(a, []).append(b)
    return ends


class Mesh:
    """Positions as tuples, faces as tuples of places in them."""

    def __init__(self, positions, faces):
        self.positions = positions
        self.faces = faces

    def boundary_loops(self):
        """Simple loops: half-edges without an opposite one, chained, and cut where they pass a vertex twice."""
        ends = border_ends(self.faces)
        loops = []
        for start in sorted(ends):
            chain = [start]
            while ends.get(chain[-1]):
                vertex = ends[chain[-1]].pop()
                if vertex in chain:
                    begin = chain.index(vertex)
                    loops.append(chain[begin:])
                    del chain[begin + 1:]
                else:
                    chain.append(vertex)
        return loops

    def without(self, removed):
        """Without these vertices, the faces at them, and then the vertices that no face uses."""
        faces = [face for face in self.faces if not any(vertex in removed for vertex in face)]
        used = sorted({vertex for face in faces for vertex in face})
        place = {vertex: i for i, vertex in enumerate(used)}
        return Mesh([self.positions[vertex] for vertex in used],
                    [tuple(place[vertex] for vertex in face) for face in faces])


def read_header(lines):
    """Format, and the elements as (name, count, [(count type or None, type, name)])."""
    encoding, elements = "", []
    for line in lines:
        words = line.split()
        if words[:1] == ["format"]:
            encoding = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"] and words[1] == "list":
            elements[-1][2].append((words[2], words[3], words[4]))
        elif words[:1] == ["property"]:
            elements[-1][2].append((None, words[1], words[2]))
    return encoding, elements


def ascii_values(body):
    words = iter(body.split())
    return lambda kind, count: tuple(float(next(words)) if SIZES[kind] in "fd" else int(next(words))
                                     for _ in range(count))


def binary_values(body, order):
    at = 0

    def take(kind, count):
        nonlocal at
        form = f"{order}{count}{SIZES[kind]}"
        values = struct.unpack_from(form, body, at)
        at += struct.calcsize(form)
        return values

    return take


def read_mesh(file):
    with open(file, "rb") as stream:
        content = stream.read()
    end = content.index(b"\n", content.index(b"end_header")) + 1
    encoding, elements = read_header(content[:end].decode("latin-1").splitlines())
    body = content[end:]
    if encoding == "ascii":
        take = ascii_values(body)
    else:
        take = binary_values(body, "<" if encoding == "binary_little_endian" else ">")
    positions, faces = [], []
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for count_type, kind, key in properties:
                row[key] = take(kind, take(count_type, 1)[0]) if count_type else take(kind, 1)[0]
            if name == "vertex":
                positions.append((row["x"], row["y"], row["z"]))
            elif name == "face":
                faces.append(row["vertex_indices"] if "vertex_indices" in row else row["vertex_index"])
    return Mesh(positions, faces)


def write_ply(file, positions, faces=None):
    """Binary little-endian, coordinates as float."""
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n"
              "property float x\nproperty float y\nproperty float z\n")
    if faces is not None:
        header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    partial = f"{file}.partial"
    with open(partial, "wb") as out:
        out.write(f"{header}end_header\n".encode())
        for position in positions:
            out.write(struct.pack("<3f", *position))
        for face in faces or ():
            out.write(struct.pack(f"<B{len(face)}i", len(face), *face))
    os.replace(partial, file)


def cut_balls(mesh, spacing, radii, margin, seed):
    """Removes the vertices in one ball per radius, around vertices drawn at random. Balls keep `margin` from each
    other and from the mesh's own boundary. Lengths but `spacing` are in spacings."""
    draw = random.Random(seed)
    boundary = [mesh.positions[vertex] for loop in mesh.boundary_loops() for vertex in loop]
    balls = []
    for radius in sorted(radii, reverse=True):
        for _ in range(10_000):
            centre = draw.choice(mesh.positions)
            apart = all(math.dist(centre, other) > (radius + taken + margin) * spacing for other, taken in balls)
            if apart and all(math.dist(centre, p) > (radius + margin) * spacing for p in boundary):
                balls.append((centre, radius))
                break
        else:
            raise SystemExit(f"mesh.py: no room for a hole of {radius:.1f} spacings; fewer or smaller ones fit")
    return mesh.without({vertex for vertex, position in enumerate(mesh.positions)
                         if any(math.dist(position, centre) <= radius * spacing for centre, radius in balls)})
