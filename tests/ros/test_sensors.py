#!/usr/bin/env python3
"""What sensors and the battery say, in ROS' own types: frames, covariances, stamps."""

import unittest

import harness
from geometry_msgs.msg import TwistWithCovarianceStamped
from harness import Recording, description, flight, step
from sensor_msgs.msg import (
    BatteryState,
    FluidPressure,
    Imu,
    LaserScan,
    MagneticField,
    NavSatFix,
    Range,
)

MAST = (
    '<link name="mast"><inertial><mass value="0.01"/><inertia ixx="1e-6" iyy="1e-6" izz="1e-6" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="mast" type="fixed">'
    '<parent link="frame"/><child link="mast"/><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/>'
    "</joint>"
)
MOUNTED = {"link": "mast", "rate": 100}


def plugin(name, **tags):
    inner = "".join(f"<{tag}>{value}</{tag}>" for tag, value in tags.items())
    return f'<gazebo><plugin name="{name}" filename="lib{name}_plugin.so">{inner}</plugin></gazebo>'


SENSORS = (
    plugin("imu", **MOUNTED, gyroNoise=0.001, accelerometerNoise=0.02)
    + plugin("gps", **MOUNTED, latitude=45, horizontalNoise=2, verticalDrift=3, velocityNoise=0.5)
    + plugin("barometer", **MOUNTED, delay=0.02)
    + plugin("magnetometer", **MOUNTED, noise=1e-7)
    + plugin("range", **MOUNTED, minRange=0.2, maxRange=8)
    + plugin("lidar", **MOUNTED, samples=5, minAngle=-1, maxAngle=1, maxRange=20)
    + plugin(
        "battery",
        **{"fullVoltage": 12, "emptyVoltage": 10, "capacity": 2, "resistance": 0, "charge": 0.5},
    )
)
# Of each topic the type, and when the last message of 0.05 s was measured.
HEARD = {
    "imu": (Imu, 0.05),
    "fix": (NavSatFix, 0.05),
    "fix/velocity": (TwistWithCovarianceStamped, 0.05),
    "pressure": (FluidPressure, 0.03),
    "magnetic_field": (MagneticField, 0.05),
    "range": (Range, 0.05),
    "scan": (LaserScan, 0.05),
    "battery": (BatteryState, 0.049),
}


def diagonal(matrix):
    side = round(len(matrix) ** 0.5)
    return list(matrix[:: side + 1])


def stamp(message):
    return message.header.stamp.to_sec()


class TestSensors(unittest.TestCase):
    def test_sensors_speak_in_types_of_ros_of_the_link_that_they_are_mounted_on(self):
        urdf = description().replace("</robot>", MAST + SENSORS + "</robot>")
        heard = {}
        with flight("_paused:=true", urdf=urdf):
            topics = {name: Recording(f"/{name}", kind) for name, (kind, _) in HEARD.items()}
            for topic in topics.values():
                topic.wait_for_connection()
            step(50)
            for name, topic in topics.items():
                last = HEARD[name][1]
                messages = topic.wait(lambda m, t=last: m and stamp(m[-1]) > t - 1e-6)
                heard[name] = messages[-1]
                self.assertAlmostEqual(stamp(heard[name]), last, delta=1e-6)
        frames = {name: message.header.frame_id for name, message in heard.items()}
        self.assertEqual(frames.pop("fix/velocity"), "world")
        self.assertEqual(frames.pop("battery"), "drone")
        self.assertEqual(set(frames.values()), {"mast"})

        imu, fix, velocity = heard["imu"], heard["fix"], heard["fix/velocity"]
        self.assertEqual(imu.orientation_covariance[0], -1)
        self.assertAlmostEqual(imu.angular_velocity_covariance[4], 1e-6 / 0.01)
        self.assertAlmostEqual(imu.linear_acceleration_covariance[8], 4e-4 / 0.01)
        self.assertEqual(fix.position_covariance_type, NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN)
        self.assertEqual(diagonal(fix.position_covariance), [4, 4, 9])
        self.assertAlmostEqual(fix.latitude, 45, delta=1e-3)
        self.assertEqual(fix.status.status, 0)
        self.assertEqual(diagonal(velocity.twist.covariance)[:3], [0.25] * 3)
        self.assertGreater(min(diagonal(velocity.twist.covariance)[3:]), 1e6)
        self.assertAlmostEqual(heard["pressure"].fluid_pressure, 101325, delta=200)
        field = heard["magnetic_field"].magnetic_field
        self.assertAlmostEqual(field.x, 22.8758e-6, delta=1e-6)  # the mast looks north
        self.assertAlmostEqual(field.z, -42.3884e-6, delta=1e-6)
        for variance in diagonal(heard["magnetic_field"].magnetic_field_covariance):
            self.assertAlmostEqual(variance, 1e-14, delta=1e-20)
        beam, scan = heard["range"], heard["scan"]
        self.assertEqual(beam.range, float("inf"))  # it looks ahead, over flat ground
        self.assertAlmostEqual(beam.min_range, 0.2)
        self.assertEqual(beam.max_range, 8)
        self.assertEqual(len(scan.ranges), 5)
        self.assertEqual((scan.angle_min, scan.angle_max, scan.range_max), (-1, 1, 20))
        self.assertAlmostEqual(scan.angle_increment, 0.5)
        battery = heard["battery"]
        self.assertAlmostEqual(battery.voltage, 11, places=4)
        self.assertAlmostEqual(battery.percentage, 0.5, places=4)
        self.assertLessEqual(battery.current, 0)


if __name__ == "__main__":
    harness.run("sensors", TestSensors)
