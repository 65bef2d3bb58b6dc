#!/usr/bin/env python3
"""The markers for rviz show the vehicle."""

import unittest

import harness
import numpy as np
from harness import Recording, flight
from visualization_msgs.msg import Marker, MarkerArray

import quadcore as qc

FRAME = np.array([[0.0050, 0.0004, -0.0003], [0.0004, 0.0062, 0.0002], [-0.0003, 0.0002, 0.0095]])
BATTERY_AT = np.array([0.02, -0.01, -0.03])  # m, in the frame
PLACES = {
    1: (0.15, 0.12, 0.02),
    2: (-0.16, 0.12, 0.02),
    3: (-0.15, -0.13, 0.02),
    4: (0.15, -0.1, 0),
}
ROTOR_AT = np.array([0.004, 0, 0.001])  # its centre of mass, m, in its link
MASSES = {0: 1.0, **{i: 0.01 * i for i in PLACES}}


def link(name, mass, moments, at=(0, 0, 0)):
    xx, xy, xz, yy, yz, zz = moments
    return f"""<link name="{name}"><inertial><origin xyz="{" ".join(map(str, at))}"/>
  <mass value="{mass}"/><inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}"
  izz="{zz}"/></inertial></link>"""


def joint(name, kind, child, at):
    return f"""<joint name="{name}" type="{kind}"><parent link="frame"/><child link="{child}"/>
  <origin xyz="{" ".join(map(str, at))}"/><axis xyz="0 0 1"/></joint>"""


def urdf():
    parts = [
        link("frame", 0.7, FRAME[np.triu_indices(3)]),
        link("battery", 0.3, (0.0001, 0, 0, 0.0003, 0, 0.0003)),
        joint("mount", "fixed", "battery", BATTERY_AT),
    ]
    for i, at in PLACES.items():
        parts.append(link(f"propeller{i}", MASSES[i], (1e-5, 0, 0, 1.5e-5, 0, 2e-5), ROTOR_AT))
        parts.append(joint(f"rotor{i}", "continuous", f"propeller{i}", at))
    return f"""<robot name="odd">{"".join(parts)}<gazebo>
  <plugin name="air" filename="libaerodynamic_plugin.so"><rotorThrustCoeff>1.2e-5</rotorThrustCoeff>
    <rotorTorqueCoeff>2.4e-7</rotorTorqueCoeff><reactionTorque>opposing</reactionTorque></plugin>
  <plugin name="motors" filename="libmotor_plugin.so"><timeConstantUp>0.03</timeConstantUp>
    <timeConstantDown>0.05</timeConstantDown></plugin>
  <plugin name="odometry" filename="libodometry_plugin.so"/></gazebo></robot>"""


def vector(p):
    return np.array([p.x, p.y, p.z])


def rotation(q):
    w, v = q.w, vector(q)
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def about(mass, arm):
    """Moments of a point, kg m^2."""
    return mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


class TestMarkers(unittest.TestCase):
    def setUp(self):
        start = flight("_paused:=true", urdf=urdf())
        with start, Recording("/vehicle_markers", MarkerArray) as recording:
            message = recording.wait_for_count(1)[0]
        self.markers = {(m.ns, m.id): m for m in message.markers}

    def test_the_boxes_have_each_links_place_mass_and_inertia(self):
        com = 0.3 * BATTERY_AT
        lumped = (
            FRAME + about(0.7, -com) + np.diag([1e-4, 3e-4, 3e-4]) + about(0.3, BATTERY_AT - com)
        )
        rotor = np.diag([1e-5, 1.5e-5, 2e-5])
        for i, mass in MASSES.items():
            box = self.markers["boxes", i]
            self.assertEqual(box.type, Marker.CUBE)
            self.assertEqual(box.header.frame_id, f"propeller{i}" if i else "frame")
            np.testing.assert_allclose(
                vector(box.pose.position), ROTOR_AT if i else com, atol=1e-12
            )
            squares, turn = vector(box.scale) ** 2, rotation(box.pose.orientation)
            inertia = turn @ np.diag(mass / 12 * (squares.sum() - squares)) @ turn.T
            np.testing.assert_allclose(inertia, rotor if i else lumped, atol=1e-10)
            self.assertEqual(self.markers["masses", i].text, f"{mass:.4g} kg")

    def test_the_rotors_have_numbers_discs_and_the_spin_of_a_hover(self):
        simulation = qc.Simulation(qc.read_model(self.written()), spawn=(0, 0, 10))
        senses = np.sign(simulation.hover_speed)
        self.assertEqual(sorted(senses), [-1, -1, 1, 1])
        for i, place in PLACES.items():
            number, disc, spin = (self.markers[name, i] for name in ("numbers", "discs", "spins"))
            self.assertEqual(number.text, str(i))
            for marker in (number, disc, spin):
                self.assertEqual(marker.header.frame_id, "frame")
                np.testing.assert_allclose(vector(marker.pose.position)[:2], place[:2], atol=1e-12)
            np.testing.assert_allclose(vector(disc.pose.position), place, atol=1e-12)
            a, b = (vector(point) for point in spin.points[:2])
            self.assertEqual(np.sign(np.cross(a, b)[2]), senses[i - 1])
        nearest = min(
            np.linalg.norm(np.subtract(PLACES[i], PLACES[j])) for i in PLACES for j in range(1, i)
        )
        self.assertLess(self.markers["discs", 1].scale.x, nearest)

    def test_the_dot_is_the_whole_vehicles_centre_of_mass(self):
        moments = 0.3 * BATTERY_AT + sum(MASSES[i] * (PLACES[i] + ROTOR_AT) for i in PLACES)
        dot = self.markers["centre_of_mass", 0]
        expected = moments / sum(MASSES.values())
        np.testing.assert_allclose(vector(dot.pose.position), expected, atol=1e-12)

    def written(self):
        file = harness.folder_of(self) / "odd.urdf"
        file.write_text(urdf())
        return file


if __name__ == "__main__":
    harness.run("markers", TestMarkers)
