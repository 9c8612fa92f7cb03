"""Writes Parquet files for tests. It follows the format's own page (apache/parquet-format) and
shares no code with the reader. `write(path, columns, **how)`: each column is (type, values); values
of a list column are lists, None is a null. A type may be a Struct, with dicts as values, or
Structs, with lists of dicts."""
import struct
import zlib

import snappy
import zstandard

BOOL, INT32, INT64, FLOAT, DOUBLE, TEXT = 0, 1, 2, 4, 5, 6
PLAIN, RLE, DELTA, RLE_DICTIONARY = 0, 3, 5, 8
NONE, SNAPPY, GZIP, ZSTD = 0, 1, 2, 6
FORMATS = {INT32: "<i", INT64: "<q", FLOAT: "<f", DOUBLE: "<d"}


def varint(n):
    out = b""
    while n >= 0x80:
        out += bytes([n & 0x7F | 0x80])
        n >>= 7
    return out + bytes([n])


def zigzag(n):
    return varint(n << 1 if n >= 0 else (-n << 1) - 1)


class Struct:
    """A struct of fields, each a type. `optional`: it may be null; `needed`: fields that may not
    be; `repeated`: fields that are lists, which is only declared."""

    def __init__(self, fields, optional=True, needed=(), repeated=()):
        self.fields, self.optional = fields, optional
        self.needed, self.repeated = needed, repeated


NULL, TEXTS = "null", "texts"  # of fields of Structs; values of both are None


class Structs:
    """A list of structs, whose fields may all be null. `element`: its name in the schema."""

    def __init__(self, fields, element="element"):
        self.fields, self.element = fields, element

    def leaves(self, name):
        """Below TEXTS another list is declared."""
        for field, of in self.fields.items():
            path = [name, "list", self.element, field]
            if of == TEXTS:
                yield Leaf([*path, "list", self.element], TEXT, 7, True, field, 2)
            else:
                yield Leaf(path, INT32 if of == NULL else of, 4, True, field)

    def schema(self, name):
        made = [{3: I32(1), 4: name, 5: I32(1), 6: I32(3)}, {3: I32(2), 4: "list", 5: I32(1)},
                {3: I32(1), 4: self.element, 5: I32(len(self.fields))}]
        for field, of in self.fields.items():
            leaf = {1: I32(INT32 if of == NULL else TEXT if of == TEXTS else of), 3: I32(1),
                    4: field}
            if of == NULL:
                leaf[10] = {11: {}}
            if of in (TEXT, TEXTS):
                leaf[6] = I32(0)
            if of == TEXTS:
                made += [{3: I32(1), 4: field, 5: I32(1), 6: I32(3)},
                         {3: I32(2), 4: "list", 5: I32(1)}]
                leaf[4] = self.element
            made.append(leaf)
        return made


class Leaf:
    """The place of values in the schema. `most`: the definition level of a present value; `field`:
    of the struct, else None; `repeats`: the greatest repetition level."""

    def __init__(self, path, kind, most, is_list=False, field=None, repeats=1):
        self.path, self.kind, self.most = path, kind, most
        self.is_list, self.field, self.repeats = is_list, field, repeats


def leaves_of(name, kind, is_list):
    if isinstance(kind, Structs):
        return list(kind.leaves(name))
    if isinstance(kind, Struct):
        return [Leaf([name, field], of, int(kind.optional) + (field not in kind.needed),
                     field=field) for field, of in kind.fields.items()]
    path = [name, "list", "element"] if is_list else [name]
    return [Leaf(path, kind, 3 if is_list else 1, is_list)]


class I32(int):
    """A 32-bit integer; int itself has 64 bits."""


def thrift(value):
    """Encodes a value as (type, bytes): a dict is a struct of fields by number."""
    if isinstance(value, bool):
        return (1 if value else 2), b""
    if isinstance(value, I32):
        return 5, zigzag(value)
    if isinstance(value, int):
        return 6, zigzag(value)
    if isinstance(value, (str, bytes)):
        raw = value.encode() if isinstance(value, str) else value
        return 8, varint(len(raw)) + raw
    if isinstance(value, list):
        items = [thrift(item) for item in value]
        kind = items[0][0] if items else 12
        head = bytes([len(items) << 4 | kind]) if len(items) < 15 else \
            bytes([0xF0 | kind]) + varint(len(items))
        return 9, head + b"".join(raw for _, raw in items)
    out, last = b"", 0
    for number in sorted(value):
        kind, raw = thrift(value[number])
        near = number - last
        out += (bytes([near << 4 | kind]) if near <= 15 else bytes([kind]) + zigzag(number)) + raw
        last = number
    return 12, out + b"\0"


def hybrid(values, bits):
    """Encodes runs of eight or more as runs, others packed, eight numbers per group."""
    out, at = b"", 0

    def run(i):
        end = i
        while end < len(values) and values[end] == values[i]:
            end += 1
        return end - i

    while at < len(values):
        if run(at) >= 8:
            n = run(at)
            out += varint(n << 1) + values[at].to_bytes((bits + 7) // 8, "little")
            at += n
            continue
        end = at
        while end < len(values) and ((end - at) % 8 or run(end) < 8):
            end += 1
        group = values[at:end] + [0] * (-(end - at) % 8)
        word = sum(value << bits * i for i, value in enumerate(group))
        out += varint(len(group) // 8 << 1 | 1) + word.to_bytes(len(group) * bits // 8, "little")
        at = end
    return out


def plain(kind, values):
    if kind == BOOL:
        bits = sum(int(value) << i for i, value in enumerate(values))
        return bits.to_bytes((len(values) + 7) // 8, "little")
    if kind == TEXT:
        raw = [v if isinstance(v, bytes) else v.encode() for v in values]
        return b"".join(struct.pack("<I", len(v)) + v for v in raw)
    return b"".join(struct.pack(FORMATS[kind], value) for value in values)


def packed(codec, raw):
    if codec == SNAPPY:
        return snappy.compress(raw)
    return zstandard.ZstdCompressor().compress(raw) if codec == ZSTD else raw


def levels(rows, leaf):
    """Returns the repetition levels, the definition levels, and the present values of rows."""
    repetitions, definitions, there = [], [], []
    for row in rows:
        if leaf.field is not None and leaf.is_list:
            for i, item in enumerate(row or [None]):
                value = item and item[leaf.field]
                repetitions.append(min(i, 1))
                definitions.append(0 if row is None else 1 if not row else 2 if item is None else
                                   3 if value is None else 4)
                there += [] if value is None else [value]
            continue
        if leaf.field is not None:
            value = None if row is None else row[leaf.field]
            repetitions.append(0)
            definitions.append(leaf.most if value is not None else
                               0 if row is None else leaf.most - 1)
            there += [] if value is None else [value]
            continue
        items = row if leaf.is_list else [row]
        if row is None or not items:
            repetitions.append(0)
            definitions.append(0 if row is None else 1)
            continue
        for i, item in enumerate(items):
            repetitions.append(min(i, 1))
            definitions.append(leaf.most - (item is None))
            if item is not None:
                there.append(item)
    return repetitions, definitions, there


class Writer:
    """`bare`: a column without values has no dictionary, and a page without values has no bytes
    of values, not even packed ones."""

    def __init__(self, codec=SNAPPY, dictionary=False, version=1, page_rows=1000, group_rows=10**6,
                 checksums=False, encoding=None, claims=None, codec_said=None, bad_place=False,
                 cut_anywhere=False, bare=False):
        self.codec, self.dictionary, self.version = codec, dictionary, version
        self.page_rows, self.group_rows, self.checksums = page_rows, group_rows, checksums
        self.encoding, self.claims, self.codec_said = encoding, claims, codec_said
        self.bad_place, self.cut_anywhere, self.bare = bad_place, cut_anywhere, bare
        self.out = b"PAR1"

    def page(self, head, raw, body):
        head.update({2: I32(len(raw)), 3: I32(len(body))})
        if self.checksums:
            crc = zlib.crc32(body)
            head[4] = I32(crc - (1 << 32) if crc >= 1 << 31 else crc)
        self.out += thrift(head)[1] + body

    def pages(self, rows, leaf):
        """Returns levels and values of each page: of whole rows, or cut anywhere, as by old
        writers."""
        if not self.cut_anywhere:
            for first in range(0, len(rows), self.page_rows):
                yield levels(rows[first:first + self.page_rows], leaf)
            return
        repetitions, definitions, there = levels(rows, leaf)
        for first in range(0, len(repetitions), self.page_rows):
            part = slice(first, first + self.page_rows)
            count = sum(level == leaf.most for level in definitions[part])
            yield repetitions[part], definitions[part], there[:count]
            there = there[count:]

    def chunk(self, leaf, rows):
        kind, begin, dictionary, dictionary_at = leaf.kind, len(self.out), None, None
        if self.dictionary and kind != BOOL:
            dictionary = sorted(set(levels(rows, leaf)[2]))
        if dictionary or dictionary is not None and not self.bare:
            raw = plain(kind, dictionary)
            dictionary_at = begin
            self.page({1: I32(2), 7: {1: I32(len(dictionary)), 2: I32(PLAIN)}}, raw,
                      packed(self.codec, raw))
        data_at, count = len(self.out), 0
        for repetitions, definitions, there in self.pages(rows, leaf):
            parts = [hybrid(repetitions, leaf.repeats) if leaf.is_list else b"",
                     hybrid(definitions, leaf.most.bit_length()) if leaf.most else b""]
            encoding, values = PLAIN, b""
            if dictionary is not None:
                encoding, width = RLE_DICTIONARY, max(1, (len(dictionary) - 1).bit_length())
                places = [dictionary.index(value) for value in there]
                if self.bad_place:
                    places = [2**width - 1 for _ in places]
                values = b"" if self.bare and not there else bytes([width]) + hybrid(places, width)
            elif kind == BOOL and self.version == 2:
                encoding, runs = RLE, hybrid([int(value) for value in there], 1)
                values = struct.pack("<I", len(runs)) + runs
            else:
                values = plain(kind, there)
            said = I32(encoding if self.encoding is None else self.encoding)
            claimed = I32(len(repetitions) if self.claims is None else self.claims)
            count += int(claimed)
            if self.version == 1:
                sized = [struct.pack("<I", len(part)) + part for part in parts if part]
                raw = b"".join(sized) + values
                self.page({1: I32(0), 5: {1: claimed, 2: said, 3: I32(RLE), 4: I32(RLE)}}, raw,
                          packed(self.codec, raw))
            else:
                raw = b"".join(parts)
                self.page({1: I32(3), 8: {1: claimed, 2: I32(definitions.count(0)),
                                          3: I32(self.page_rows), 4: said, 5: I32(len(parts[1])),
                                          6: I32(len(parts[0])), 7: self.codec != NONE}},
                          raw + values,
                          raw + (packed(self.codec, values) if values or not self.bare else b""))
        codec = self.codec if self.codec_said is None else self.codec_said
        about = {1: I32(kind), 2: [I32(PLAIN)], 3: leaf.path, 4: I32(codec), 5: count,
                 6: len(self.out) - begin, 7: len(self.out) - begin, 9: data_at}
        if dictionary_at is not None:
            about[11] = dictionary_at
        return {2: begin, 3: about}

    @staticmethod
    def struct_schema(name, kind, values, nested):
        """Returns a schema element. `nested`: its fields are in another struct, only declared."""
        schema = [{3: I32(int(kind.optional)), 4: name, 5: I32(len(kind.fields))}]
        if nested:
            schema = [{**schema[0], 5: I32(1)},
                      {3: I32(0), 4: next(iter(kind.fields)), 5: I32(len(kind.fields))}]
        for field, of in kind.fields.items():
            repetition = 2 if field in kind.repeated else int(field not in kind.needed)
            leaf = {1: I32(of), 3: I32(repetition), 4: field}
            if of == TEXT and any(row and isinstance(row[field], str) for row in values):
                leaf[6] = I32(0)
            schema.append(leaf)
        return schema

    def write(self, columns, nested=(), unsigned=()):
        """`nested`: lists in lists, or structs in structs, only declared;
        `unsigned`: unsigned numbers, by their logical type."""
        schema = [{4: "schema", 5: I32(len(columns))}]
        leaves = []
        for name, (kind, values) in columns.items():
            is_list = any(isinstance(value, list) for value in values)
            leaves += [(leaf, values) for leaf in leaves_of(name, kind, is_list)]
            if isinstance(kind, Struct):
                schema += self.struct_schema(name, kind, values, name in nested)
                continue
            if isinstance(kind, Structs):
                schema += kind.schema(name)
                continue
            leaf = {1: I32(kind), 3: I32(1), 4: "element" if is_list else name}
            if kind == TEXT and not any(isinstance(value, bytes) for value in values):
                leaf[6] = I32(0)
            if name in unsigned:
                leaf[10] = {10: {2: False}}
            if is_list:
                schema += [{3: I32(1), 4: name, 5: I32(1), 6: I32(3)},
                           {3: I32(2), 4: "list", 5: I32(1)}]
                if name in nested:
                    schema += [{3: I32(1), 4: "element", 5: I32(1), 6: I32(3)},
                               {3: I32(2), 4: "list", 5: I32(1)}]
            schema.append(leaf)
        total = len(next(iter(columns.values()))[1])
        groups = []
        for first in range(0, total, self.group_rows):
            rows = min(self.group_rows, total - first)
            chunks = [self.chunk(leaf, values[first:first + rows]) for leaf, values in leaves]
            groups.append({1: chunks, 2: 0, 3: rows})
        footer = thrift({1: I32(2), 2: schema, 3: total, 4: groups, 6: "tests"})[1]
        return self.out + footer + struct.pack("<I", len(footer)) + b"PAR1"


def write(path, columns, nested=(), unsigned=(), **how):
    with open(path, "wb") as file:
        file.write(Writer(**how).write(columns, nested, unsigned))
