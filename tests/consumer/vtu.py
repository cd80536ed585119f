"""Reads what `qtet extract` writes: one piece of tetrahedra, appended raw. As a program: its volume
and fields, as levels.c prints them."""
import array
import struct
import sys
import xml.etree.ElementTree as ElementTree

TYPES = {
    "Float32": "f",
    "Float64": "d",
    "Int8": "b",
    "UInt8": "B",
    "Int16": "h",
    "UInt16": "H",
    "Int32": "i",
    "UInt32": "I",
    "Int64": "q",
    "UInt64": "Q",
}


class Vtu:
    """points: flat list of coordinates; tetrahedra: flat list of ids; fields: (name, kind,
    components, type letter, flat values), points' first."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        mark = data.index(b"_", data.index(b"<AppendedData"))
        root = ElementTree.fromstring(data[: data.index(b"<AppendedData")] + b"</VTKFile>")
        size_letter = "Q" if root.get("header_type") == "UInt64" else "I"

        def values(element):
            at = mark + 1 + int(element.get("offset"))
            (count,) = struct.unpack_from("<" + size_letter, data, at)
            at += struct.calcsize(size_letter)
            out = array.array(TYPES[element.get("type")], data[at : at + count])
            return out

        piece = root.find("UnstructuredGrid/Piece")
        points = piece.find("Points/DataArray")
        self.point_type = TYPES[points.get("type")]
        self.points = values(points)
        self.tetrahedra = values(piece.find("Cells/DataArray[@Name='connectivity']"))
        self.fields = [
            (e.get("Name"), kind, int(e.get("NumberOfComponents")), TYPES[e.get("type")], values(e))
            for kind in ("PointData", "CellData")
            for e in piece.iterfind(kind + "/DataArray")
        ]

    def volume(self):
        total = 0.0
        for i in range(0, len(self.tetrahedra), 4):
            a, b, c, d = (self.points[3 * v : 3 * v + 3] for v in self.tetrahedra[i : i + 4])
            u, v, w = ([p[k] - a[k] for k in range(3)] for p in (b, c, d))
            total += (
                (u[1] * v[2] - u[2] * v[1]) * w[0]
                + (u[2] * v[0] - u[0] * v[2]) * w[1]
                + (u[0] * v[1] - u[1] * v[0]) * w[2]
            )
        return total / 6


if __name__ == "__main__":
    mesh = Vtu(sys.argv[1])
    print("volume %.9g" % mesh.volume())
    for name, _, _, _, numbers in mesh.fields:
        print("%s: %.9g to %.9g" % (name, min(numbers), max(numbers)))
