"""A module with the interface of the Crazyflie firmware's bindings, written from its source alone.

Mellinger's law and the power distribution follow src/modules/src/controller/controller_mellinger.c
and src/modules/src/power_distribution_quadrotor.c (commit 2a18fc2), without integrals.
"""

import math
from types import SimpleNamespace

import numpy as np

modeDisable, modeAbs = 0, 1
GRAVITY = 9.81


def vector(*names):
    return SimpleNamespace(**dict.fromkeys(names, 0.0))


def state_t():
    return SimpleNamespace(
        position=vector(*"xyz"),
        velocity=vector(*"xyz"),
        attitudeQuaternion=vector(*"xyzw"),
        attitude=vector("roll", "pitch", "yaw"),
    )


def sensorData_t():
    return SimpleNamespace(gyro=vector(*"xyz"), acc=vector(*"xyz"))


def setpoint_t():
    return SimpleNamespace(
        position=vector(*"xyz"),
        velocity=vector(*"xyz"),
        acceleration=vector(*"xyz"),
        attitude=vector("roll", "pitch", "yaw"),
        attitudeRate=vector("roll", "pitch", "yaw"),
        mode=vector("x", "y", "z", "yaw"),
    )


def control_t():
    return vector("thrust", "roll", "pitch", "yaw")


def motors_thrust_uncapped_t():
    return SimpleNamespace(motors=vector("m1", "m2", "m3", "m4"))


motors_thrust_pwm_t = motors_thrust_uncapped_t


def controllerMellinger_t():
    return vector("mass", "massThrust", "kp_xy", "kd_xy", "kp_z", "kd_z", "kR_xy", "kw_xy", "kR_z")


def controllerMellingerInit(self):
    gains = {"kp_xy": 0.4, "kd_xy": 0.2, "kp_z": 1.25, "kd_z": 0.4}
    vars(self).update(gains, kR_xy=70000.0, kw_xy=20000.0, kR_z=60000.0)


def read(vector):
    return np.array(list(vars(vector).values()))


def controllerMellinger(self, control, setpoint, sensors, state, step):
    if step % 2:  # the controller runs at 500 Hz
        return
    assert vars(setpoint.mode) == dict.fromkeys(("x", "y", "z", "yaw"), modeAbs)
    slip = read(setpoint.velocity) - read(state.velocity)
    error = read(setpoint.position) - read(state.position)
    kp, kd = (np.array([a, a, b]) for a, b in ((self.kp_xy, self.kp_z), (self.kd_xy, self.kd_z)))
    wanted = read(setpoint.acceleration) + np.array([0, 0, GRAVITY])
    force = self.mass * wanted + kp * error + kd * slip
    x, y, z, w = read(state.attitudeQuaternion)
    axes = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    heading = math.radians(setpoint.attitude.yaw)
    up = force / np.linalg.norm(force)
    left = np.cross(up, [math.cos(heading), math.sin(heading), 0])
    left /= np.linalg.norm(left)
    goal = np.stack([np.cross(left, up), left, up], axis=1)
    skew = goal.T @ axes - axes.T @ goal
    rates = np.radians(read(sensors.gyro))
    moment = -self.kR_xy * np.array([skew[2, 1], skew[0, 2], 0]) - self.kw_xy * rates
    control.thrust = self.massThrust * float(force @ axes[:, 2])
    control.roll, control.pitch = moment[0], -moment[1]  # the firmware's pitch lowers the tail
    control.yaw = self.kR_z * skew[1, 0] + 12000 * rates[2]


def powerDistribution(control, thrusts):
    r, p, y = control.roll / 2, control.pitch / 2, control.yaw
    thrusts.motors.m1 = control.thrust - r + p + y
    thrusts.motors.m2 = control.thrust - r - p - y
    thrusts.motors.m3 = control.thrust + r - p + y
    thrusts.motors.m4 = control.thrust + r + p - y


def powerDistributionCap(thrusts, ratios):
    for name, value in vars(thrusts.motors).items():
        setattr(ratios.motors, name, int(min(max(value, 0), 65535)))
