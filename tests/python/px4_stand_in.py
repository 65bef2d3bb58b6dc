"""A small autopilot that speaks the MAVLink of PX4's simulator interface, from its source alone.

Conventions are those of src/modules/simulator/simulator_mavlink.cpp and src/modules/mavlink (commit
34160bb6). All axes are forward, right, down and north, east, down.
"""

import argparse
import collections
import math
import os
import select
import signal
import socket
import struct
import sys
import time

import numpy as np
from pymavlink.dialects.v20 import common as mavlink

X, Y, SPIN = (1, -1, 1, -1), (1, -1, -1, 1), (1, 1, -1, -1)  # FR, RL, FL, RR; y to the right
POSITION, VELOCITY, LEVEL, RATE, YAW = 2.0, 2.6, 6.0, 0.1, 0.3
FORCE, TURN = 9.8, np.array([0.0, 0.0, -1.0])
DECLINATION = math.radians(3.659)  # World Magnetic Model at 47.3977 N, 8.5456 E in 2026
UNANSWERED = 5  # packets of sensors before the first packet of motors
OFFBOARD, METRES = 6, 111319.49


def to_matrix(w, x, y, z):
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class Estimator:
    """Attitude by gyroscopes from level; position and velocity corrected by the receiver."""

    def __init__(self, first):
        self.time = first.time_usec * 1e-6
        yaw = math.atan2(-first.ymag, first.xmag) + DECLINATION
        self.q = np.array([math.cos(yaw / 2), 0, 0, math.sin(yaw / 2)])
        self.p, self.v, self.origin = np.zeros(3), np.zeros(3), None

    def feel(self, sensor):
        step, self.time = sensor.time_usec * 1e-6 - self.time, sensor.time_usec * 1e-6
        self.rates = np.array([sensor.xgyro, sensor.ygyro, sensor.zgyro])
        w, x, y, z = self.q
        a, b, c = 0.5 * step * self.rates
        change = [
            -x * a - y * b - z * c,
            w * a + y * c - z * b,
            w * b - x * c + z * a,
            w * c + x * b - y * a,
        ]
        self.q = (self.q + change) / np.linalg.norm(self.q + change)
        self.r = to_matrix(*self.q)
        self.force = np.array([sensor.xacc, sensor.yacc, sensor.zacc])
        self.p = self.p + step * self.v
        self.v = self.v + step * (self.r @ self.force + [0, 0, FORCE])

    def locate(self, gps):
        assert gps.fix_type == 3
        place = np.array([gps.lat * 1e-7, gps.lon * 1e-7, gps.alt * 1e-3])
        if self.origin is None:
            self.origin = place
        north, east = (place - self.origin)[:2] * METRES
        east *= math.cos(math.radians(self.origin[0]))
        down = self.origin[2] - place[2]
        self.p = self.p + 0.15 * (np.array([north, east, down]) - self.p)
        self.v = self.v + 0.3 * (np.array([gps.vn, gps.ve, gps.vd]) / 100 - self.v)


class Autopilot:
    def __init__(self, faults):
        self.faults = faults
        self.parameters = {"MPC_THR_HOVER": (0.5, 9), "THR_MDL_FAC": (0.3, 9)}
        for name in ("COM_RCL_EXCEPT", "NAV_DLL_ACT", "COM_OBL_ACT"):
            self.parameters[name] = (0.0, 6)
        self.parameters["COM_DISARM_PRFLT"] = (10.0, 9)
        self.mode, self.armed, self.wanted = 0, False, None

    def answer(self, message):
        """Handle a message of the pilot, and return the answers."""
        kind = message.get_type()
        if kind in ("PARAM_REQUEST_READ", "PARAM_SET"):
            name = message.param_id
            if name not in self.parameters:
                return []
            value, sort = self.parameters[name]
            if kind == "PARAM_SET" and "stubborn" not in self.faults:
                assert message.param_type == sort
                given = message.param_value
                value = struct.unpack("<i", struct.pack("<f", given))[0] if sort == 6 else given
                self.parameters[name] = value, sort
            sent = struct.unpack("<f", struct.pack("<i", int(value)))[0] if sort == 6 else value
            return [mavlink.MAVLink_param_value_message(name.encode(), sent, sort, 6, 0)]
        if kind == "SET_POSITION_TARGET_LOCAL_NED":
            assert message.coordinate_frame == 1 and message.type_mask == 0
            self.wanted = message
        elif kind == "COMMAND_LONG" and message.command == 176:
            assert message.param1 == 1
            self.mode = int(message.param2)
        elif kind == "COMMAND_LONG" and message.command == 400 and self.mode == OFFBOARD:
            if "no_arm" in self.faults:
                return [mavlink.MAVLink_statustext_message(4, b"Arming denied: compass")]
            self.armed = bool(message.param1)
        return []

    def mix(self, e):
        if not self.armed:
            return [0.0] * 4
        s = self.wanted
        error = np.array([s.x, s.y, s.z]) - e.p
        wanted = np.array([s.afx, s.afy, s.afz]) + POSITION * error
        wanted = wanted + VELOCITY * (np.array([s.vx, s.vy, s.vz]) - e.v)
        force = wanted - [0, 0, FORCE]
        up = e.r.T @ (force / np.linalg.norm(force))
        heading = math.atan2(e.r[1, 0], e.r[0, 0])
        turn = math.remainder(s.yaw - heading, 2 * math.pi)
        rates = LEVEL * np.cross(TURN, up) + [0, 0, s.yaw_rate + 2 * turn]
        a, b, c = (k * (v - g) for k, v, g in zip((RATE, RATE, YAW), rates, e.rates))
        level = self.parameters["MPC_THR_HOVER"][0] * float(-force @ e.r[:, 2]) / FORCE
        thrusts = [level - y * a + x * b + s * c for x, y, s in zip(X, Y, SPIN)]
        return [math.sqrt(min(max(thrust, 0.01), 1.0)) for thrust in thrusts]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-i", dest="instance", type=int, required=True)
    parser.add_argument("--fault", action="append", default=[], help="NAME[=VALUE]")
    given = parser.parse_args()
    faults = {}
    for text in given.fault:
        name, _, value = text.partition("=")
        faults[name] = float(value or 1)
    assert os.environ["PX4_SIM_MODEL"] == "iris"
    time.sleep(faults.get("slow", 0))
    radio = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    radio.bind(("127.0.0.1", 14580 + given.instance))
    ground = "127.0.0.1", 14540 + given.instance
    link = socket.create_connection(("127.0.0.1", 4560 + given.instance))
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    print("INFO  [simulator] Simulator connected on TCP", flush=True)
    mav = mavlink.MAVLink(None, given.instance + 1, 1)
    pilot, estimator = Autopilot(faults), None
    happened = collections.Counter()

    def now(name):
        """Whether a fault happens at this time, once."""
        happened[name] += name in faults and sensor.time_usec * 1e-6 >= faults[name]
        return happened[name] == 1

    while True:
        received = link.recv(65536)
        if not received:
            return
        for sensor in mav.parse_buffer(received) or ():
            if sensor.get_type() == "HIL_GPS" and estimator:
                estimator.locate(sensor)
            if sensor.get_type() != "HIL_SENSOR":
                continue
            assert sensor.fields_updated & 0x3F == 0x3F
            estimator = estimator or Estimator(sensor)
            estimator.feel(sensor)
            while select.select([radio], [], [], 0)[0]:
                for message in mav.parse_buffer(radio.recv(65536)) or ():
                    for answer in pilot.answer(message):
                        radio.sendto(answer.pack(mav), ground)
            if now("die"):
                print("ERROR [px4] Segmentation fault", flush=True)
                os.kill(os.getpid(), signal.SIGKILL)
            if now("leave"):
                link.close()
                signal.pause()
            if now("disarm"):
                pilot.armed = False
            happened["sensor"] += 1
            if happened["sensor"] <= UNANSWERED:
                continue
            outputs = pilot.mix(estimator)
            if now("nan"):
                outputs[2] = math.nan
            flags = 1 | (128 if pilot.armed else 0)
            controls = [*outputs, *[0.0] * 12]
            packet = mavlink.MAVLink_hil_actuator_controls_message(
                sensor.time_usec, controls, flags, 1
            ).pack(mav)
            if now("garbage"):
                packet = b"GET / HTTP/1.1\r\n"
            if now("checksum"):
                packet = packet[:-1] + bytes([packet[-1] ^ 1])
            if happened["sensor"] % 10 == 0:
                tell(radio, ground, mav, pilot, estimator)
            link.sendall(packet)


def tell(radio, ground, mav, pilot, e):
    ms, (w, x, y, z) = int(e.time * 1e3), e.q
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(2 * (w * y - z * x))
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    for message in (
        mavlink.MAVLink_heartbeat_message(2, 12, 81, pilot.mode << 16, 4, 3),
        mavlink.MAVLink_local_position_ned_message(ms, *e.p, *e.v),
        mavlink.MAVLink_attitude_message(ms, roll, pitch, yaw, *e.rates),
    ):
        radio.sendto(message.pack(mav), ground)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
