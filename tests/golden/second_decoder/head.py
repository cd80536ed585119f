"""Header, manifest and chunk table, and where the blocks lie."""
import struct

from coder import Stream
from conventions import LEVEL_END, Reader, refuse_unless


class Row:
    """A row of the chunk table."""


class Log:
    def __init__(self, data, misreading=""):
        self.data, self.misreading = data, misreading
        header = struct.unpack("<8sHHBBHQIIIIIIIIII", data[:64])
        (_, major, _, layout, self.bits, _, size, manifest, table) = header[:9]
        self.chunks, self.fields = header[11], header[12]
        closing, later_bytes = header[14:16]
        refuse_unless(major == 4 and layout == 0, "another version")
        refuse_unless(size == len(data), "another length")
        self.manifest = data[64 : 64 + manifest]
        self.offset = 64 + manifest + table
        part = data[len(data) - later_bytes :]
        reader = Reader(data[64 + manifest : self.offset])
        self.later = reader.varint()
        if self.later:
            reader.take(4)
        refuse_unless((self.later > 0) == (later_bytes > 0), "later fields without their part")
        self.shapes, self.parents = [], []
        for _ in range(self.fields - self.later):
            self.read_shape(reader)
        self.rows = []
        for _ in range(self.chunks):
            self.rows.append(self.read_row(reader))
        self.closing = {}
        for _ in range(closing):
            kind, field, count = reader.varint(), reader.varint(), reader.varint()
            reader.take(4)
            self.closing[kind, field] = data[self.offset : self.offset + count]
            self.offset += count
        refuse_unless(self.offset + later_bytes == len(data), "blocks do not end with the file")
        self.read_manifest()
        if self.later:
            self.read_later(Reader(part), len(part))

    def read_later(self, reader, size):
        """The later fields: shapes, manifest, and their blocks of each chunk."""
        for _ in range(self.later):
            self.read_shape(reader)
        self.read_later_manifest(Reader(reader.take(reader.varint())))
        for row in self.rows:
            sizes = [reader.varint() for _ in range(self.later)]
            reader.take(4 * self.later)
            refuse_unless(sum(sizes) == row.later, "other sizes than the row says")
            for size_of in sizes:
                row.blocks.append(self.data[row.end_of_blocks : row.end_of_blocks + size_of])
                row.end_of_blocks += size_of
        refuse_unless(reader.at == size, "bytes behind the later fields")

    def read_shape(self, reader):
        """A field's components and association, and the fields that it is predicted from."""
        components, association = reader.unpack("BB")
        parents = []
        if association & 64:
            for _ in range(reader.u8()):
                parent = reader.varint()
                refuse_unless(parent < len(self.shapes), "a parent behind its child")
                kind = self.shapes[parent][0], self.shapes[parent][1] & 127
                refuse_unless(kind == (components, association & 63), "a parent of another kind")
                parents.append((parent, reader.unpack("b")[0]))
            refuse_unless(1 <= len(parents) <= 4, "parents")
        self.shapes.append((components, association & 191))
        self.parents.append(parents)

    def read_row(self, reader):
        row = Row()
        before = self.rows[-1] if self.rows else None
        row.first = before.last + (before.end is LEVEL_END) if before else 0
        row.last = row.first + reader.varint()
        end = reader.varint()
        row.end = LEVEL_END if end == 0 else end - 1
        if end and self.misreading == "slot e is visited too":
            row.end = end
        row.records = reader.varint()
        row.vertices, row.tetrahedra, row.triangles = (reader.varint() for _ in range(3))
        row.codec = reader.u8() >> 4
        sizes = [reader.varint() for _ in range(2 + self.fields - self.later)]
        row.later = (reader.varint() << 32 | reader.varint()) if self.later else 0
        reader.take(4 * len(sizes))
        row.blocks = []
        for size in sizes:
            row.blocks.append(self.data[self.offset : self.offset + size])
            self.offset += size
        row.end_of_blocks = self.offset
        self.offset += row.later
        return row

    def read_manifest(self):
        reader = Reader(self.manifest)
        reader.text()
        reader.text()
        self.step, *self.origin = reader.unpack("4d")
        self.infos = [self.read_info(reader, shape) for shape in self.shapes]
        flags = self.flags = reader.u8()
        refuse_unless(flags < 64, "flags of the manifest")
        six = "6B" if self.misreading == "a focus has six bytes" else "6H"
        self.focus = reader.unpack(six) if flags & 2 else None
        if self.focus:
            refuse_unless(
                all(low < high for low, high in zip(self.focus, self.focus[3:])), "an empty focus"
            )
        if flags & 4:
            field, cut = reader.unpack("BB")
            refuse_unless(field < len(self.shapes) and cut <= 3, "the opening's field or axis")
        if flags & 8:
            names, pairs = [], reader.varint()
            if self.misreading == "units are as many texts as the varint says":
                pairs //= 2
            for _ in range(pairs):
                names.append(reader.text())
                refuse_unless(1 <= len(reader.text().encode()) <= 64, "a unit's length")
            refuse_unless(names == sorted(set(names)), "units in another order")
        if flags & 16:
            self.labels = dict(self.read_label(reader) for _ in range(reader.varint()))
            refuse_unless(list(self.labels) == sorted(self.labels), "labels in another order")
        self.original = None
        if flags & 32:
            two = "2Q" if self.misreading == "counts of the original are integers" else "2d"
            self.original = reader.unpack(two)
            refuse_unless(all(n == int(n) and 0 <= n <= 2**53 for n in self.original), "a count")
        self.columns = self.columns_of(reader, flags, len(self.shapes))
        if self.original:
            last = [column[-1] for column in self.columns[:2]]
            refuse_unless(all(n >= m for n, m in zip(self.original, last)), "a small original")

    def read_label(self, reader):
        field, count = reader.text(), reader.varint()
        refuse_unless(field and count <= 4096, "a label")
        names = {}
        for _ in range(count):
            (value,) = reader.unpack("I" if self.misreading == "labels are unsigned" else "i")
            refuse_unless(all(value > before for before in names), "names in another order")
            names[value] = reader.text()
            refuse_unless(names[value], "a value without a name")
        return field, names

    def read_info(self, reader, shape):
        components = shape[0]
        reader.text()
        kind, bits, step = reader.unpack("BBd")
        minimum = reader.unpack(f"{components}d")
        reader.unpack("2d")
        return kind & 127, bits, step, minimum

    def read_later_manifest(self, reader):
        """The columns are those of the manifest again, and 0 but for the later fields' own."""
        self.infos += [self.read_info(reader, shape) for shape in self.shapes[-self.later :]]
        if not self.flags & 1:
            refuse_unless(reader.at == len(reader.data), "bytes behind the last later field")
            return
        columns = self.columns_of(reader, 1, self.later)
        refuse_unless(columns[3] == self.columns[3], "errors of other levels")
        self.columns += columns[10:]

    def columns_of(self, reader, flags, fields):
        stream = Stream(reader.take(len(reader.data) - reader.at), None, self.misreading)
        columns = self.read_columns(stream, self.rows[-1].last + 1, flags, fields)
        refuse_unless(stream.at_end(), "level columns are too long")
        return columns

    def read_columns(self, stream, levels, flags, fields):
        errors = flags & 1
        pairs = 6 if errors else 3  # the first column of a pair
        columns = pairs + (2 * (2 + fields) if errors else 0)
        out = []
        known = [1] * levels
        for column in range(columns):
            stays = column >= pairs and (column - pairs) % 2 == 1 or errors and column == 3
            if self.misreading == "a max is predicted like a mean":
                stays = False
            told = []  # of the levels that are known
            for level in range(levels):
                if column > 3 and not known[level]:
                    if self.misreading == "an unknown level has entries":
                        stream.number(column)
                    if self.misreading == "an unknown level counts in predictions":
                        told.append(told[-1])
                    continue
                predicted = told[-1] if told else 0
                if len(told) > 1 and not stays:
                    predicted = 2 * told[-1] - told[-2]
                code = stream.number(column)
                difference = code // 2 if code % 2 == 0 else -(code + 1) // 2
                told.append((predicted + difference) % 2**32)
            if errors and column == 3:
                known = told
                refuse_unless(all(k < 2 for k in known), "an error is known or not")
                refuse_unless(known[0] and known[-1], "an end without a known error")
            out.append(told)
        for column in range(pairs, columns, 2):
            for mean, most in zip(out[column], out[column + 1]):
                refuse_unless(mean <= most <= 17100, "a mean above its maximum")
        return out
