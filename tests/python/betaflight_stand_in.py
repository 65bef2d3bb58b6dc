"""A small autopilot that speaks the bytes of Betaflight's SITL, written from its source alone.

Conventions are those of betaflight/src/platform/SIMULATOR/sitl.c and target/SITL/target.h (commit
301d01a). Body axes inside: forward, left, up.
"""

import argparse
import math
import os
import select
import signal
import socket
import struct
import sys
import time
from pathlib import Path

X, Y, SPIN = (-1, 1, -1, 1), (-1, -1, 1, 1), (-1, 1, 1, -1)  # motors: RR, FR, RL, FL
IDLE, ANGLE, YAW_RATE = 0.055, math.radians(60), math.radians(200)
LEVEL, RATE, YAW = 6.0, 0.06, 0.25  # 1/s, s, s


def provision(path):
    """Set parameters as Betaflight's `--config`, which prints what it did."""
    values = {}
    for line in Path(path).read_text().splitlines():
        word, _, rest = line.partition(" ")
        name, _, value = (part.strip() for part in rest.partition("="))
        if word == "set" and name == "bogus":
            print(f"###ERROR IN set: INVALID NAME: {rest}###")
        elif word == "set":
            values[name] = "180" if name == "stubborn" else value
            print(f"{name} set to {value}")
        elif word == "get":
            print(f"# get {rest}\n{rest} = {values.get(rest, '0')}\nAllowed range: 0 - 180")
    Path("eeprom.bin").write_text(repr(values))
    print("[CONFIG] Config file processed, EEPROM saved")


class Autopilot:
    def __init__(self, faults):
        self.faults = faults
        self.up = [0.0, 0.0, 1.0]
        self.heading = 0.0
        self.channels = [1500, 1500, 1000, 1500, 1000, 1000] + [1000] * 10
        self.armed = False
        self.test = [1000] * 4
        self.last = None
        self.throttle_was_low = False

    def flip(self, name, value):
        return -value if name in self.faults else value

    def update(self, packet):
        t, p, q, r, ax, ay, az = packet[:7]
        gyro = [p, -q, r]
        gyro = [self.flip(f"gyro_{n}", v) for n, v in zip("xyz", gyro)]
        acc = [self.flip(f"acc_{n}", -a) for n, a in zip("xyz", (ax, ay, az))]
        dt = 0.0 if self.last is None else t - self.last
        self.last = t
        self.estimate(gyro, acc, dt)
        return self.mix(gyro)

    def estimate(self, gyro, acc, dt):
        (p, q, r), (x, y, z) = gyro, self.up
        norm = math.sqrt(sum(a * a for a in acc)) or 1.0
        gain = min(1.0, dt * (0.2 if self.armed else 5.0))
        turned = (x + dt * (r * y - q * z), y + dt * (p * z - r * x), z + dt * (q * x - p * y))
        new = [u + gain * (a / norm - u) for u, a in zip(turned, acc)]
        norm = math.sqrt(sum(u * u for u in new))
        self.up = [u / norm for u in new]
        self.heading += dt * (self.up[1] * q + self.up[2] * r)

    def angles(self):
        x, y, z = self.up
        return math.atan2(y, z), math.atan2(-x, math.hypot(y, z))

    def mix(self, gyro):
        roll, pitch, throttle, yaw = ((c - 1500) / 500 for c in self.channels[:4])
        wants = self.channels[4] > 1700
        if wants and not self.armed and throttle < -0.9 and "no_arm" not in self.faults:
            self.armed = True
        if not wants or ("disarm" in self.faults and self.last > self.faults["disarm"]):
            self.armed = False
        if not self.armed:
            return [(us - 1000) / 1000 for us in self.test]
        phi, theta = self.angles()
        wanted = (LEVEL * (roll * ANGLE - phi), LEVEL * (pitch * ANGLE - theta), -yaw * YAW_RATE)
        a, b, c = (k * (w - g) for k, w, g in zip((RATE, RATE, YAW), wanted, gyro))
        c = self.flip("yaw_spin", c)
        level = IDLE + (1 - IDLE) * (throttle + 1) / 2
        out = [level + y * a - x * b - s * c for x, y, s in zip(X, Y, SPIN)]
        return [max(IDLE, min(1.0, each)) for each in out]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--config")
    parser.add_argument("--ports", nargs=4, type=int, default=[9002, 9003, 9004, 5761])
    parser.add_argument("--fault", action="append", default=[], help="NAME[=VALUE]")
    given = parser.parse_args()
    if given.config:
        provision(given.config)
        return
    faults = {}
    for text in given.fault:
        name, _, value = text.partition("=")
        faults[name] = float(value or 1)
    motors, state, radio, msp = given.ports
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    states = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    states.bind(("127.0.0.1", state))
    sticks = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sticks.bind(("127.0.0.1", radio))
    sticks.setblocking(False)
    server = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    server.bind(("127.0.0.1", msp))
    server.listen(1)
    print("[SITL] ready")
    pilot, clients, answer, count = Autopilot(faults), {}, None, 0
    while True:
        for ready in select.select([states, server, *clients], [], [])[0]:
            if ready is server:
                clients[server.accept()[0]] = b""
            elif ready is not states:
                serve_msp(pilot, ready, clients)
            else:
                packet = struct.unpack("<18d", states.recv(4096))
                for _ in range(100):
                    try:
                        pilot.channels = list(struct.unpack("<d16H", sticks.recv(4096))[1:])
                    except BlockingIOError:
                        break
                if packet[0] != pilot.last:  # asked again if it has the same time
                    count += 1
                    answer = pack(pilot, packet, count, faults)
                    if "drop" in faults and count % int(faults["drop"]) == 0:
                        continue
                out.sendto(answer, ("127.0.0.1", motors))


def pack(pilot, packet, count, faults):
    outputs = pilot.update(packet)
    t = packet[0]
    if "swap" in faults:  # 12 swaps motors 1 and 2
        i, j = (int(c) - 1 for c in str(int(faults["swap"])))
        outputs[i], outputs[j] = outputs[j], outputs[i]
    if "dead" in faults:
        outputs[int(faults["dead"]) - 1] = 0.0
    if "die" in faults and t > faults["die"]:
        print("segmentation violation in the mixer", flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
    if "nan" in faults and t > faults["nan"]:
        outputs[0] = math.nan
    if "pause" in faults and t > faults["pause"]:
        faults.pop("pause")
        time.sleep(2.5)
    if "no_arm" in faults and count % 500 == 0:
        print("[SITL] Arming disabled: ACC_CALIBRATION", flush=True)
    packed = struct.pack("<4f", *outputs)
    return packed[:12] if "short" in faults and t > faults["short"] else packed


def serve_msp(pilot, client, clients):
    """Answer MSP version 1: 108 attitude, 214 motors of the bench."""
    data = client.recv(4096)
    if not data:
        clients.pop(client)
        return
    clients[client] += data
    while len(clients[client]) >= 6:
        frame = clients[client]
        size, command = frame[3], frame[4]
        if len(frame) < size + 6:
            return
        payload, clients[client] = frame[5 : 5 + size], frame[6 + size :]
        reply = b""
        if command == 108:
            roll, pitch = pilot.angles()
            heading = round(-math.degrees(pilot.heading)) % 360
            reply = struct.pack(
                "<hhh", round(10 * math.degrees(roll)), round(10 * math.degrees(pitch)), heading
            )
        elif command == 214:
            pilot.test = list(struct.unpack("<4H", payload[:8]))
        body = bytes([len(reply), command]) + reply
        check = 0
        for byte in body:
            check ^= byte
        start = b"$X>" if "magic" in pilot.faults else b"$M>"
        client.sendall(start + body + bytes([check]))


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
