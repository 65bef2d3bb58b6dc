"""Files of recordings, written by hand from the documentation of their formats."""

from __future__ import annotations

import struct
import zlib


def make_crazyflie(events, rows, version=2):
    """Events: number -> (name, [variable with its type]); rows: (event, time in us, values)."""
    data = struct.pack("<BHH", 0xBC, version, len(events))
    for number, (name, variables) in events.items():
        data += struct.pack("<H", number) + name.encode() + b"\0"
        data += struct.pack("<H", len(variables))
        data += b"".join(variable.encode() + b"\0" for variable in variables)
    for number, time, values in rows:
        letters = "".join(variable[-2] for variable in events[number][1])
        data += struct.pack(f"<HQ{letters}", number, time, *values)
    return data + struct.pack("<I", zlib.crc32(data))


def make_ulog(topics, version=1, flags=True):
    """Topics: name -> (fields of the format, [values]); every topic begins with its timestamp."""
    data = b"ULog\x01\x12\x35" + bytes([version]) + struct.pack("<Q", 0)

    def message(kind, body):
        return struct.pack("<HB", len(body), ord(kind)) + body

    if flags:
        data += message("B", bytes(40))
    for name, (fields, _) in topics.items():
        text = f"{name}:uint64_t timestamp;" + "".join(f"{field};" for field in fields)
        data += message("F", text.encode())
    for number, name in enumerate(topics):
        data += message("A", struct.pack("<BH", 0, number) + name.encode())
    for number, (fields, rows) in enumerate(topics.values()):
        letters = "".join(_letter(field) for field in fields)
        for time, *values in rows:
            body = struct.pack(f"<HQ{letters}", number, time, *values)
            data += message("D", body)
    return data


def _letter(field):
    kind = field.split()[0]
    count = int(kind[:-1].partition("[")[2]) if "[" in kind else 1
    return {"float": "f", "int32_t": "i", "uint8_t": "B"}[kind.partition("[")[0]] * count


def write_unsigned(value):
    """Seven bits per byte; the highest bit tells that more follow."""
    value &= 0xFFFFFFFF
    data = b""
    while value > 127:
        data += bytes([value & 0x7F | 0x80])
        value >>= 7
    return data + bytes([value])


def write_signed(value):
    """0, -1, 1, -2 ... as 0, 1, 2, 3 ..."""
    return write_unsigned(value << 1 ^ value >> 31)


def write_tagged(values):
    """TAG8_8SVB."""
    tag = sum(1 << i for i, value in enumerate(values) if value)
    return bytes([tag]) + b"".join(write_signed(value) for value in values if value)


def write_three(values):
    """TAG2_3S32."""
    if all(-2 <= v <= 1 for v in values):
        a, b, c = (v & 3 for v in values)
        return bytes([a << 4 | b << 2 | c])
    if all(-8 <= v <= 7 for v in values):
        a, b, c = (v & 15 for v in values)
        return bytes([0x40 | a, b << 4 | c])
    if all(-32 <= v <= 31 for v in values):
        a, b, c = (v & 63 for v in values)
        return bytes([0x80 | a, b, c])
    return bytes([0xC0 | 0b111111]) + b"".join(struct.pack("<i", v) for v in values)


def write_four(values):
    """TAG8_4S16, with the smallest sizes."""
    tag, stream, halves = 0, 0, 0
    for i, v in enumerate(values):
        size, bits = next(
            (size, bits)
            for size, bits in enumerate((0, 4, 8, 16))
            if (bits == 0 and v == 0) or (bits and -(1 << bits - 1) <= v < 1 << bits - 1)
        )
        tag |= size << 2 * i
        stream = stream << bits | v & ((1 << bits) - 1)
        halves += bits // 4
    if halves % 2:
        stream, halves = stream << 4, halves + 1
    return bytes([tag]) + stream.to_bytes(halves // 2, "big")


MARKER = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n"
NAMES = [
    "loopIteration", "time", "axisP[0]", "axisP[1]", "axisP[2]", "vbatLatest",
    "gyroADC[0]", "gyroADC[1]", "gyroADC[2]", "motor[0]", "motor[1]", "motor[2]", "motor[3]",
]  # fmt: skip


def make_blackbox(rows, every=4, header=(), p_interval="1/1"):
    """Rows of the fields NAMES; every 4th frame is an I frame."""
    lines = [
        "Data version:2",
        f"I interval: {every}",
        f"P interval:{p_interval}",
        f"Field I name:{','.join(NAMES)}",
        "Field I signed:0,0,1,1,1,0,1,1,1,0,0,0,0",
        "Field I predictor:0,0,0,0,0,9,0,0,0,4,5,5,5",
        "Field I encoding:1,1,0,0,0,3,0,0,0,1,0,0,0",
        "Field P predictor:6,2,1,1,1,1,3,3,3,3,3,3,3",
        "Field P encoding:9,0,7,7,7,6,0,0,0,8,8,8,8",
        "vbatref:1600",
        "minthrottle:1000",
        "maxthrottle:2000",
        "acc_1G:4096",
        *header,
    ]
    data = (MARKER + "".join(f"H {line}\n" for line in lines)).encode()
    last = before = None
    for n, row in enumerate(rows):
        if n % every == 0:
            data += b"I" + write_unsigned(row[0]) + write_unsigned(row[1])
            data += b"".join(write_signed(v) for v in row[2:5])
            data += write_unsigned(-(row[5] - 1600) & 0x3FFF)
            data += b"".join(write_signed(v) for v in row[6:9]) + write_unsigned(row[9] - 1000)
            data += b"".join(write_signed(v - row[9]) for v in row[10:13])
            last = before = row
        else:
            mean = [int((a + b) / 2) for a, b in zip(last, before)]
            data += b"P" + write_signed(row[1] - (2 * last[1] - before[1]))
            data += write_three([a - b for a, b in zip(row[2:5], last[2:5])])
            data += write_signed(row[5] - last[5])
            data += b"".join(write_signed(a - b) for a, b in zip(row[6:9], mean[6:9]))
            data += write_four([a - b for a, b in zip(row[9:13], mean[9:13])])
            last, before = row, last
    return data
