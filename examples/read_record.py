#!/usr/bin/env python3
"""Reads a port record (docs/port-record.md) without understudy: one line for each entry.
usage: read_record.py FILE"""
import struct
import sys
import zlib

STATUS = "ok queue_full deadline_exceeded faulted rejected no_frame".split()
with open(sys.argv[1], "rb") as file:
    magic, axes = file.readline().split()
    assert magic == b"understudy.port-record/1", "no record of a port"
    n = int(axes)
    while head := file.read(5):
        size, kind = struct.unpack("<IB", head) if len(head) == 5 else (0, 0)
        body, end = file.read(size), file.read(4)
        if len(end) < 4 or zlib.crc32(head[4:] + body) != struct.unpack("<I", end)[0]:
            sys.exit("the last entry is not whole")
        if kind == 1:
            print("note", body.decode())
        elif kind == 2:
            now, deadline, answer, count = struct.unpack_from("<ddBI", body)
            print("submit", now, STATUS[answer], count)
            for setpoint in struct.iter_unpack(f"<d{n}d{n}ddi", body[21:]):
                print("  setpoint", setpoint[0], setpoint[-1], *setpoint[1:n + 1], setpoint[-2])
        elif kind == 3:
            state = struct.unpack(f"<dd{n}dQQQBB", body)
            print("state", state[0], "executed", state[n + 3], "of", state[n + 2], *state[2:n + 2])
        else:
            print({4: "wait", 5: "urgent", 6: "outputs", 7: "frame", 8: "load"}.get(kind, kind), *struct.unpack_from("<d", body))
