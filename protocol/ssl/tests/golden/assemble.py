#!/usr/bin/env python3
"""Writes the golden packets: every message of facts.txt, encoded by a writer of its own.

A second program on purpose: it shares nothing with the Rust structs but the facts. Plain Python, no library.
Run it in this folder after a change of facts.txt; the test reads what is committed and needs no Python.

For each package PACKAGE.bin holds the packets, each after its length (varint), and PACKAGE.jsonl what is in them, a line
a packet. Samples of a message:
  full     every field set; of a oneof one member, so there is a `full` a member
  zero     every field set to zero or the empty string
  least    only what is required, zero
Order within a packet: by number; a oneof stands where its lowest number would (protobuf leaves the order free).
Enum samples, in enums.tsv: every number with its name.
"""

import json
import struct
from pathlib import Path

HERE = Path(__file__).parent
VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5
SCALARS = {"float", "double", "int32", "int64", "uint32", "uint64", "sint64", "bool", "string", "bytes", "opaque"}


def read_facts():
    messages, enums, current = {}, {}, None
    for line in (HERE / "facts.txt").read_text(encoding="utf8").splitlines():
        words = line.split()
        if not words or line.startswith("#"):
            continue
        if words[0] == "message":
            current = messages.setdefault((words[1], words[2]), [])
        elif words[0] == "enum":
            current = enums.setdefault((words[1], words[2]), [])
        elif len(words) == 2:
            current.append((int(words[0]), words[1]))
        else:
            oneof = [word[len("oneof="):] for word in words if word.startswith("oneof=")]
            current.append({
                "number": int(words[0]), "name": words[1], "type": words[2],
                "required": "required" in words, "repeated": "repeated" in words, "packed": "packed" in words,
                "oneof": oneof[0] if oneof else None,
            })
    return messages, enums


MESSAGES, ENUMS = read_facts()


def resolve(package, name):
    """The message or enum a type names: its own package first, then the only other one of that name."""
    for table in (MESSAGES, ENUMS):
        if (package, name) in table:
            return (package, name)
    found = [key for table in (MESSAGES, ENUMS) for key in table if key[1] == name]
    if len(found) > 1:  # the controller's, which simulators share; never the trackers' or 2014's
        found = [key for key in found if key[0] in ("gc", "vision")]
    assert len(found) == 1, (package, name, found)
    return found[0]


def varint(number):
    number &= (1 << 64) - 1
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    out.append(number)
    return bytes(out)


def key(number, wire):
    return varint(number << 3 | wire)


def delimited(payload):
    return varint(len(payload)) + payload


class Samples:
    """Values that differ from field to field, the same at every run."""

    def __init__(self, zero=False, least=False):
        self.zero, self.least, self.count = zero, least, 0

    def scalar(self, kind, name):
        """The value, its wire type, its bytes."""
        self.count += 1
        n, sign = self.count, -1 if self.count % 2 else 1
        if kind in ("float", "double"):
            value = sign * n * 0.25 if kind == "float" else sign * (1.7e9 + n * 0.125)
            value = 0.0 if self.zero else value
            form, wire = ("<f", FIXED32) if kind == "float" else ("<d", FIXED64)
            return value, wire, struct.pack(form, value)
        if kind in ("int32", "int64", "sint64", "uint32", "uint64"):
            large = {"int32": 2**30, "int64": 2**61, "sint64": 2**61, "uint32": 2**31, "uint64": 2**63}[kind]
            value = n if n % 3 else large + n
            value = value if kind.startswith("u") else sign * value
            value = 0 if self.zero else value
            coded = (value << 1) ^ (value >> 63) if kind == "sint64" else value
            return value, VARINT, varint(coded)
        if kind == "bool":
            value = not self.zero
            return value, VARINT, varint(int(value))
        if kind == "string":
            value = "" if self.zero else f'{name} {n} "µ"'
            return value, BYTES, delimited(value.encode("utf8"))
        if kind in ("bytes", "opaque"):
            value = b"" if self.zero else bytes([0, n & 255, 255, 10])
            return list(value), BYTES, delimited(value)
        raise ValueError(kind)

    def enum(self, values):
        self.count += 1
        number, name = values[0] if self.zero else values[1 + self.count % (len(values) - 1)]
        return name, VARINT, varint(number)

    def value(self, package, field, stack):
        if field["type"] in SCALARS:
            return self.scalar(field["type"], field["name"])
        found = resolve(package, field["type"])
        if found in ENUMS:
            return self.enum(ENUMS[found])
        fields, payload = self.message(found, stack)
        return fields, BYTES, delimited(payload)

    def message(self, which, stack=(), member=None):
        """The fields by name, and the bytes."""
        package, _ = which
        members = {}
        for field in MESSAGES[which]:
            members.setdefault(field["oneof"], []).append(field)
        # A message within itself ends there: it is given without its oneof.
        chosen = {} if which in stack else {
            oneof: member or choices[self.count % len(choices)]["name"] for oneof, choices in members.items() if oneof
        }
        shown, parts = {}, []
        for field in MESSAGES[which]:
            number, oneof = field["number"], field["oneof"]
            if self.least and not field["required"] or oneof and chosen.get(oneof) != field["name"]:
                continue
            times = 2 if field["repeated"] else 1
            values = [self.value(package, field, stack + (which,)) for _ in range(times)]
            if field["packed"]:
                part = key(number, BYTES) + delimited(b"".join(coded for _, _, coded in values))
            else:
                part = b"".join(key(number, wire) + coded for _, wire, coded in values)
            shown[field["name"]] = [value for value, _, _ in values] if field["repeated"] else values[0][0]
            parts.append((min(choice["number"] for choice in members[oneof]) if oneof else number, part))
        return shown, b"".join(part for _, part in sorted(parts, key=lambda part: part[0]))


def samples(which):
    members = [field["name"] for field in MESSAGES[which] if field["oneof"]] or [None]
    for member in members:
        yield "full", Samples().message(which, member=member)
    yield "zero", Samples(zero=True).message(which)
    yield "least", Samples(zero=True, least=True).message(which)


def main():
    for package in dict.fromkeys(package for package, _ in MESSAGES):
        packets, lines = bytearray(), []
        for which in [which for which in MESSAGES if which[0] == package]:
            for sample, (fields, payload) in samples(which):
                packets += delimited(payload)
                line = {"message": which[1], "sample": sample, "fields": fields}
                lines.append(json.dumps(line, ensure_ascii=False))
        (HERE / f"{package}.bin").write_bytes(packets)
        (HERE / f"{package}.jsonl").write_text("\n".join(lines) + "\n", encoding="utf8")
    rows = [f"{package}\t{name}\t{number}\t{value}" for (package, name), values in ENUMS.items() for number, value in values]
    (HERE / "enums.tsv").write_text("\n".join(rows) + "\n", encoding="utf8")


main()
