"""A small autopilot that speaks the bytes of ArduPilot's JSON interface, from its source alone.

Conventions are those of libraries/SITL/SIM_JSON.cpp and SIM_JSON.h (commit 0394cbc): the state is
found by searching for keys, and angles are of axes forward, right, down in north, east, down.
"""

import argparse
import math
import os
import re
import select
import signal
import socket
import struct
import sys
from pathlib import Path

X, Y, SPIN = (1, -1, 1, -1), (1, -1, -1, 1), (1, 1, -1, -1)  # FR, RL, FL, RR; y to the right
ANGLE, YAW_RATE, IDLE = math.radians(45), math.radians(200), 0.1
LEVEL, RATE, YAW = 6.0, 0.06, 0.25  # 1/s, s, s
KEYS = {"timestamp": 1, "gyro": 3, "accel_body": 3, "position": 3, "quaternion": 4, "velocity": 3}


def read_state(text):
    """Search for the keys as parse_sensors does; a vector's bracket follows the colon at once."""
    state = {}
    for key, size in KEYS.items():
        at = text.index(key) + len(key) + 2
        if size == 1:
            state[key] = float(re.match(r"[-+.\de]+", text[at:]).group())
        else:
            assert text[at] == "[", text
            state[key] = [float(part) for part in text[at + 1 : text.index("]", at)].split(",")]
            assert len(state[key]) == size
    return state


class Autopilot:
    def __init__(self):
        self.channels = [1500, 1500, 1000, 1500, 1000]
        self.armed = False

    def mix(self, state, faults):
        roll, pitch, throttle, yaw = ((c - 1500) / 500 for c in self.channels[:4])
        wants = self.channels[4] > 1700 and "no_arm" not in faults
        self.armed = wants and (self.armed or throttle < -0.9)
        if "disarm" in faults and state["timestamp"] > faults["disarm"]:
            self.armed = False
        if not self.armed:
            return [0.0] * 4
        w, x, y, z = state["quaternion"]
        phi = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        theta = math.asin(2 * (w * y - z * x))
        # A forward stick lowers the nose: a negative pitch.
        wanted = (LEVEL * (roll * ANGLE - phi), LEVEL * (-pitch * ANGLE - theta), yaw * YAW_RATE)
        a, b, c = (k * (v - g) for k, v, g in zip((RATE, RATE, YAW), wanted, state["gyro"]))
        level = (throttle + 1) / 2
        out = [level - y * a + x * b + s * c for x, y, s in zip(X, Y, SPIN)]
        return [max(IDLE, min(1.0, each)) for each in out]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ports", nargs=2, type=int, required=True)
    parser.add_argument("--defaults", required=True)
    parser.add_argument("--fault", action="append", default=[], help="NAME[=VALUE]")
    given = parser.parse_args()
    assert "RC5_OPTION 153\n" in Path(given.defaults).read_text()
    faults = {}
    for text in given.fault:
        name, _, value = text.partition("=")
        faults[name] = float(value or 1)
    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sticks = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sticks.bind(("127.0.0.1", given.ports[1]))
    sticks.setblocking(False)
    link.bind(("127.0.0.1", 0))
    pilot, outputs, count, dropped, t = Autopilot(), [0.0] * 4, 0, set(), -1.0
    print("Starting SITL: JSON", flush=True)
    while True:
        pulses = [round(1000 + 1000 * output) for output in outputs]
        number = 0 if "reset" in faults and t > faults["reset"] else count
        magic = 29569 if "magic" in faults and t > faults["magic"] else 18458
        packet = struct.pack("<HHI16H", magic, 1000, number, *pulses, *[0] * 12)
        if "short" in faults and t > faults["short"]:
            packet = packet[:20]
        if "die" in faults and t > faults["die"]:
            print("ERROR: Floating point exception - aborting", flush=True)
            os.kill(os.getpid(), signal.SIGKILL)
        if "drop" in faults and count and count % int(faults["drop"]) == 0 and count not in dropped:
            dropped.add(count)
        else:
            link.sendto(packet, ("127.0.0.1", given.ports[0]))
        while not select.select([link], [], [], 1.0)[0]:
            print("No JSON sensor message received, resending servos", flush=True)
            link.sendto(packet, ("127.0.0.1", given.ports[0]))
        new = read_state(link.recv(65536).decode().strip("\n"))
        for _ in range(100):
            try:
                channels = struct.unpack("<16H", sticks.recv(4096))
            except BlockingIOError:
                break
            pilot.channels = [new or old for new, old in zip(channels, pilot.channels)]
        if new["timestamp"] != t:  # asked again if it has the same time
            outputs = pilot.mix(new, faults)
            count += 1
        t = new["timestamp"]


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
