"""An independent reader of AEDAT4, AEDAT 3.1, RPG text and our LCM logs, for tests: nothing
but numpy, no code shared with the program. Prints what it found as JSON:

    python3 read_recording.py FILE

Written from the formats' descriptions (of logs: LCM's event log and msg/*.lcm); LZ4 blocks are unpacked here, ZSTD is not known.
Sums are over whole numbers, so that they compare exactly.
"""
import decimal
import json
import struct
import sys

import numpy as np

EVENT4 = np.dtype({"names": ["t", "x", "y", "on"], "formats": ["<i8", "<i2", "<i2", "u1"],
                   "offsets": [0, 8, 10, 12], "itemsize": 16})


def lz4_block(block, out):
    """Appends one block's content; matches may reach back into earlier blocks."""
    at = 0

    def length(nibble, at):
        total = nibble
        while nibble == 15:
            total += block[at]
            at += 1
            if block[at - 1] != 255:
                break
        return total, at

    while at < len(block):
        token = block[at]
        literals, at = length(token >> 4, at + 1)
        out += block[at:at + literals]
        at += literals
        if at == len(block):
            return
        back = block[at] | block[at + 1] << 8
        match, at = length(token & 15, at + 2)
        for _ in range(match + 4):
            out.append(out[-back])


def lz4_frame(data):
    magic, flags = struct.unpack_from("<IB", data)
    assert magic == 0x184D2204 and flags >> 6 == 1
    at = 7 + (8 if flags & 8 else 0) + (4 if flags & 1 else 0)
    out = bytearray()
    while True:
        (size,) = struct.unpack_from("<I", data, at)
        at += 4
        if size == 0:
            return bytes(out)
        block = data[at:at + (size & 0x7FFFFFFF)]
        if size >> 31:
            out += block
        else:
            lz4_block(block, out)
        at += len(block) + (4 if flags & 16 else 0)


class Table:
    """A flatbuffer's table at `at` of `data`."""

    def __init__(self, data, at):
        self.data, self.at = data, at
        self.vtable = at - struct.unpack_from("<i", data, at)[0]
        self.vtable_size = struct.unpack_from("<H", data, self.vtable)[0]

    @staticmethod
    def root(data):
        """Of a size-prefixed buffer, with its four letters."""
        return data[8:12].decode(), Table(data, 4 + struct.unpack_from("<I", data, 4)[0])

    def place(self, field):
        slot = 4 + 2 * field
        if slot >= self.vtable_size:
            return 0
        return struct.unpack_from("<H", self.data, self.vtable + slot)[0]

    def number(self, field, kind, default=0):
        place = self.place(field)
        return struct.unpack_from("<" + kind, self.data, self.at + place)[0] if place else default

    def vector(self, field):
        """Where the elements begin, and how many there are."""
        at = self.at + self.place(field)
        at += struct.unpack_from("<I", self.data, at)[0]
        return at + 4, struct.unpack_from("<I", self.data, at)[0]

    def bytes(self, field):
        at, count = self.vector(field)
        return self.data[at:at + count]

    def tables(self, field):
        at, count = self.vector(field)
        for slot in range(at, at + 4 * count, 4):
            yield Table(self.data, slot + struct.unpack_from("<I", self.data, slot)[0])


class Found:
    def __init__(self, name):
        self.events, self.frames, self.imu, self.triggers = [], [], [], []
        self.name = name

    def summary(self):
        t, x, y, on = (np.concatenate([e[i] for e in self.events]).astype(np.int64)
                       if self.events else np.zeros(0, np.int64) for i in range(4))
        return {"format": self.name, "events": len(t), "on": int(on.sum()),
                "first_us": int(t[0]) if len(t) else None, "last_us": int(t[-1]) if len(t) else None,
                # A sum that tells the order too.
                "checksum": int(((t % 1000003) * (np.arange(len(t)) % 1009 + 1)
                                 + 7 * x + 11 * y).sum()),
                "frames": self.frames, "imu": self.imu, "triggers": self.triggers}


def frame_summary(times, shape, levels):
    return {"times_us": [int(t) for t in times], "shape": list(shape),
            "sum": int(np.asarray(levels, np.int64).sum())}


def read_aedat4(data):
    found = Found("AEDAT4")
    (size,) = struct.unpack_from("<I", data, 14)
    kind, header = Table.root(data[14:18 + size])
    assert kind == "IOHE"
    compression = header.number(0, "i")
    assert compression in (0, 1, 2)
    table = header.number(1, "q", -1)
    at, end = 18 + size, len(data) if table < 0 else table
    while at < end:
        _, size = struct.unpack_from("<ii", data, at)
        packed = data[at + 8:at + 8 + size]
        at += 8 + size
        kind, root = Table.root(lz4_frame(packed) if compression else packed)
        if kind == "EVTS":
            begin, count = root.vector(0)
            events = np.frombuffer(root.data, EVENT4, count, begin)
            found.events.append([events[name] for name in ("t", "x", "y", "on")])
        elif kind == "FRME":
            assert root.number(5, "b") == 0
            found.frames.append(frame_summary(
                [root.number(i, "q") for i in (1, 2, 3, 4)],
                [root.number(i, "h") for i in (6, 7, 8, 9)],
                np.frombuffer(root.bytes(10), np.uint8)))
        elif kind == "IMUS":
            found.imu += [[each.number(0, "q")] + [each.number(i, "f") for i in range(1, 8)]
                          for each in root.tables(0)]
        elif kind == "TRIG":
            found.triggers += [[each.number(0, "q"), each.number(1, "b")]
                               for each in root.tables(0)]
    return found.summary()


def read_aedat31(data):
    found = Found("AEDAT 3.1")
    mark = b"#!END-HEADER\r\n"
    at = data.index(mark) + len(mark)
    while at < len(data):
        kind, _, size, _, overflow, _, count, _ = struct.unpack_from("<hhiiiiii", data, at)
        body = data[at + 28:at + 28 + size * count]
        at += 28 + size * count
        high = overflow << 31
        if kind in (0, 1):
            pairs = np.frombuffer(body, "<u4").reshape(-1, 2).astype(np.int64)
            info, t = pairs[:, 0], pairs[:, 1] + high
            assert (info & 1).all()
            if kind == 1:
                found.events.append([t, info >> 17, info >> 2 & 0x7FFF, info >> 1 & 1])
            else:
                found.triggers += [[int(a), int(b)] for a, b in zip(t, info >> 1 & 0x7F)]
        elif kind == 2:
            for i in range(count):
                one = body[i * size:(i + 1) * size]
                n = struct.unpack_from("<9i", one)
                assert n[0] == 3  # valid, one channel
                times = [high + t + ((1 << 31) if t < n[1] else 0) for t in n[1:5]]
                found.frames.append(frame_summary(times, n[5:9],
                                                  np.frombuffer(one[36:], "<u2")))
        elif kind == 3:
            for i in range(count):
                _, t, *values = struct.unpack_from("<Ii7f", body, i * size)
                found.imu.append([high + t] + values[6:] + values[:6])
    return found.summary()


def read_text(data):
    found = Found("text")
    rows = [line.split() for line in data.decode().splitlines()]
    t = np.array([int(decimal.Decimal(row[0]) * 1000000) for row in rows], np.int64)
    rest = np.array([[int(word) for word in row[1:]] for row in rows], np.int64).reshape(-1, 3)
    found.events.append([t, rest[:, 0], rest[:, 1], rest[:, 2]])
    return found.summary()


def lcm_messages(data):
    """Channel and content, without the 8 bytes that tell the type."""
    at, number = 0, 0
    while at < len(data):
        mark, event, _, name, size = struct.unpack_from(">Iqqii", data, at)
        assert mark == 0xEDA1DA01 and event == number
        at += 28
        number += 1
        yield data[at:at + name].decode(), data[at + name + 8:at + name + size]
        at += name + size


def read_lcm(data):
    """Samples: time, temperature, specific force (m/s2), rate (rad/s), camera axes."""
    found = Found("LCM log")
    readout, temperature = None, None
    for channel, body in lcm_messages(data):
        if channel == "NIGHTJAR_SENSOR":
            _, width, height, length = struct.unpack_from(">qiii", body)
            found.name += " %dx%d %s" % (width, height, body[20:20 + length - 1].decode())
        elif channel == "NIGHTJAR_EVENTS":
            _, begin, count = struct.unpack_from(">qqi", body)
            words = np.frombuffer(body, ">u8", count, 20).astype(np.uint64)
            one = np.uint64(0xFFFF)
            found.events.append([begin + (words >> np.uint64(33)).astype(np.int64), words & one,
                                 words >> np.uint64(16) & one, words >> np.uint64(32) & np.uint64(1)])
        elif channel == "NIGHTJAR_APS_READOUT":
            readout = struct.unpack(">qqqii", body)
        elif channel == "NIGHTJAR_APS_FRAME":
            end, begin, width, height, _, count = struct.unpack_from(">qqiiii", body)
            assert readout[0] == end
            found.frames.append(frame_summary(
                [readout[1], readout[2], begin, end], [width, height, readout[3], readout[4]],
                np.frombuffer(body, ">u2", count, 32)))
        elif channel == "NIGHTJAR_IMU_TEMPERATURE":
            temperature = struct.unpack(">qf", body)
        elif channel == "NIGHTJAR_IMU":
            t, *values = struct.unpack(">q6d", body)
            assert temperature[0] == t
            found.imu.append([t, temperature[1]] + values[3:] + values[:3])
        elif channel == "NIGHTJAR_TRIGGER":
            found.triggers.append(list(struct.unpack(">qi", body)))
    return found.summary()


def reader_of(content):
    if content.startswith(b"\xed\xa1\xda\x01"):
        return read_lcm
    if content.startswith(b"#!AER-DAT4.0\r\n"):
        return read_aedat4
    return read_aedat31 if content.startswith(b"#!AER-DAT3.1") else read_text


if __name__ == "__main__":
    with open(sys.argv[1], "rb") as file:
        content = file.read()
    print(json.dumps(reader_of(content)(content)))
