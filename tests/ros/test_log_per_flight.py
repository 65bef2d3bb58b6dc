#!/usr/bin/env python3
"""The node's log after a jump: each flight in a file of its own."""

import unittest
import xmlrpc.client

import harness
import rosgraph
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from harness import Recording, call, commander, flight, step, time_of_flight, wait_until
from nav_msgs.msg import Odometry
from quadcore.srv import SetState
from test_lockstep import LOCKSTEP, altitude_controller
from test_logs import NOISY, converted

import quadcore as qc

COMMANDS = "/b/quadrotor/vel_cmd"


def rows_of(log):
    """Give the numbers of a CSV log."""
    return [[float(x) for x in row.split(",")] for row in log.read_text().splitlines()[1:]]


def as_csv(log):
    """Give a log as CSV; the Python of ROS reads no bags."""
    target = log.with_suffix(".out.csv")
    if log.suffix == ".bag":
        return converted(log, target).read_text()
    qc.Log.of_file(log).to_file(target)
    return target.read_text()


def has_commander(node):
    """Tell whether a node listens to someone who may send commands."""
    address = rosgraph.Master("/test").lookupNode(node)
    _, _, connections = xmlrpc.client.ServerProxy(address).getBusInfo("/test")
    return any(topic == COMMANDS for _, _, _, _, topic, *_ in connections)


def move(z):
    """Put the vehicle to a height, at rest."""
    pose = Pose(position=Point(z=z), orientation=Quaternion(w=1))
    answer = rospy.ServiceProxy("/quadcore/set_state", SetState)(pose=pose)
    if not answer.success:
        raise AssertionError(answer.message)


class TestLogPerFlight(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_what_was_flown_before_a_jump_is_kept_beside_the_log(self):
        """Each flight can be read by itself, in every format, and no file is replaced."""
        rows = {}
        for suffix in ("csv", "mat", "bag"):
            folder = self.folder / suffix
            folder.mkdir()
            (folder / f"flight.before_1.{suffix}").write_text("of another day")
            with flight("_paused:=true", f"_log:={folder / 'flight'}.{suffix}", urdf=NOISY) as node:
                step(50)
                call("/gazebo/reset_simulation")
                step(30)
                call("/gazebo/reset_world")
                step(20)
                move(8.0)
                step(10)
                node.end()
            self.assertEqual(node.process.returncode, 0, node.error)
            names = ["flight", *(f"flight.before_{i}" for i in range(1, 5))]
            self.assertEqual(
                sorted(path.name for path in folder.iterdir()),
                sorted(f"{name}.{suffix}" for name in names),
            )
            self.assertEqual((folder / f"{names[1]}.{suffix}").read_text(), "of another day")
            rows[suffix] = [as_csv(folder / f"{name}.{suffix}") for name in [*names[2:], names[0]]]
        first, second, third, last = (text.splitlines()[1:] for text in rows["csv"])
        self.assertEqual([len(x) for x in (first, second, third, last)], [51, 31, 21, 11])
        self.assertEqual(first[:31], second)
        times = [float(row.split(",")[0]) for row in (second[-1], third[0], third[-1], last[0])]
        self.assertEqual((times[0], times[2]), (times[1], times[3]))
        self.assertEqual(float(last[0].split(",")[3]), 8.0)
        self.assertEqual(rows["csv"], rows["mat"])
        self.assertEqual(rows["csv"], rows["bag"])

    def check_flights(self, *ticks):
        """See that each began at the height of the start, and the milliseconds that it holds."""
        self.assertEqual(self.names(), ["flight.before_1.csv", "flight.csv"])
        flights = [rows_of(self.folder / name) for name in self.names()]
        self.assertEqual([rows[0][3] for rows in flights], [10, 10])
        self.assertEqual([[round(row[0] * 1000) for row in rows] for rows in flights], list(ticks))

    def test_a_jump_after_which_the_time_has_gone_on_begins_another_flight(self):
        """What follows the clock and is paused falls behind it, and joins it with the jump."""
        log = f"_log:={self.folder / 'flight.csv'}"
        topic = Recording("/b/odom", Odometry)
        leader = flight("_paused:=true", "_name:=leader", namespace="/a")
        with leader, flight(log, namespace="/b") as node:
            with topic as b:
                b.wait_for_publisher()
                step(50, "/a")
                b.wait(lambda m: m and m[-1].header.stamp.to_sec() == 0.05)
            call("/b/gazebo/pause_physics")
            step(100, "/a")
            wait_until(lambda: time_of_flight("/b").to_sec() == 0.15)
            call("/b/gazebo/reset_simulation")
            node.end()
        self.assertEqual(node.process.returncode, 0, node.error)
        self.check_flights([*range(51)], [150])

    def test_a_jump_that_waits_for_a_controller_begins_another_flight(self):
        """In lockstep it is seen once someone can answer; the clock may have gone on by then."""
        log = f"_log:={self.folder / 'flight.csv'}"
        with flight("_paused:=true", "_name:=leader", namespace="/a"):
            step(10, "/a")
            with flight(*LOCKSTEP[1:], log, namespace="/b") as node:
                wait_until(lambda: time_of_flight("/b").to_sec() == 0.01)
                with commander(COMMANDS) as send:

                    def act(message):
                        send(altitude_controller(message))

                    with Recording("/b/odom", Odometry, act=act) as b:
                        b.wait_for_count(1)
                        step(50, "/a")
                        b.wait(lambda m: m[-1].header.stamp.to_sec() == 0.06)
                wait_until(lambda: not has_commander("/b/quadcore"))
                call("/b/gazebo/reset_simulation")
                call("/b/gazebo/pause_physics")
                step(100, "/a")
                wait_until(lambda: time_of_flight("/b").to_sec() == 0.16)
                call("/b/gazebo/unpause_physics")
                with Recording("/b/odom", Odometry) as b, commander(COMMANDS):
                    b.wait(lambda m: m and m[-1].header.stamp.to_sec() == 0.16)
                    node.end()
        self.assertEqual(node.process.returncode, 0, node.error)
        self.check_flights([*range(10, 61)], [160])

    def test_a_log_that_was_moved_away_does_not_end_logging(self):
        log, moved = self.folder / "flight.csv", self.folder / "saved.csv"
        with flight("_paused:=true", f"_log:={log}") as node:
            step(50)
            log.rename(moved)
            call("/gazebo/reset_simulation")
            step(30)
            call("/gazebo/reset_simulation")
            step(20)
            node.end()
        self.assertEqual(node.process.returncode, 0, node.error)
        self.assertEqual(self.names(), ["flight.before_1.csv", "flight.csv", "saved.csv"])
        kept, last, saved = (rows_of(self.folder / name) for name in self.names())
        self.assertEqual([len(rows) for rows in (saved, kept, last)], [51, 31, 21])
        self.assertEqual((saved[:31], saved[:21]), (kept, last))

    def test_a_start_from_which_nothing_was_flown_is_no_flight_to_keep(self):
        log = self.folder / "flight.csv"
        with flight("_paused:=true", f"_log:={log}") as node:
            move(7.0)
            call("/gazebo/reset_simulation")
            move(8.0)
            step(10)
            node.end()
        self.assertEqual(self.names(), ["flight.csv"])
        rows = log.read_text().splitlines()[1:]
        self.assertEqual((len(rows), rows[0].split(",")[3]), (11, "8"))


if __name__ == "__main__":
    harness.run("log_per_flight", TestLogPerFlight)
