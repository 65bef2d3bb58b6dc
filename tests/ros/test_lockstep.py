#!/usr/bin/env python3
"""Lockstep: the same flight whatever the controller's pace, and nothing added to the physics."""

import random
import tempfile
import time
import unittest
from pathlib import Path

import harness
import numpy as np
import rospy
from harness import HOVER, Recording, commander, diagnostic, flight, step
from nav_msgs.msg import Odometry

import quadcore as qc

STEPS = 1500
LOCKSTEP = (
    "_paused:=true",
    "_lockstep:=true",
    "_real_time_factor:=0",
    "_lockstep_timeout:=30",  # a busy machine is no fault
)


def altitude_controller(message):
    """Rotor speeds that depend on every digit of the odometry."""
    error = 10.5 - message.pose.pose.position.z
    speed = 471 + 30 * error - 20 * message.twist.twist.linear.z
    turn = 3 * message.twist.twist.angular.x
    return [speed, -speed - turn, speed, -speed + turn]


def row(message):
    """Pose and twist as a row of a log begins."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    v, w = message.twist.twist.linear, message.twist.twist.angular
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z]


def answer_until(last, send):
    """Answer the odometry of the first milliseconds only."""

    def act(message):
        if message.header.stamp.to_nsec() <= last * 1000000:
            send(HOVER)

    return act


def fly(controller, steps, *arguments):
    """Odometry of a flight of so many steps with a controller."""
    with flight(*LOCKSTEP, *arguments), commander() as send:
        answer = lambda message: send(controller(message))  # noqa: E731
        with Recording("/odom", Odometry, act=answer) as odometry:
            odometry.wait_for_publisher()
            step(steps)
            return odometry.wait_for_count(steps + 1)


class TestLockstep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_a_slow_controller_gives_the_log_of_a_fast_one(self):
        generator = random.Random(1)

        def sleepy(message):
            if generator.random() < 0.1:
                time.sleep(generator.uniform(0, 0.02))
            return altitude_controller(message)

        fast, slow = self.folder / "fast.csv", self.folder / "slow.csv"
        fly(altitude_controller, STEPS, f"_log:={fast}")
        fly(sleepy, STEPS, f"_log:={slow}")
        self.assertEqual(len(fast.read_text().splitlines()), STEPS + 2)
        self.assertEqual(fast.read_bytes(), slow.read_bytes())

    def test_replayed_commands_give_the_log_of_the_core(self):
        generator = np.random.default_rng(2)
        table = np.column_stack(
            [np.arange(STEPS) * 0.001, HOVER + generator.uniform(-20, 20, (STEPS, 4))]
        )
        log = self.folder / "ros.csv"
        odometry = fly(
            lambda m: table[min(round(m.header.stamp.to_sec() * 1000), STEPS - 1), 1:],
            STEPS,
            f"_log:={log}",
        )
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        core = simulation.run(STEPS * 0.001, table)
        np.testing.assert_array_equal([row(m) for m in odometry], core.table[:, 1:14])
        stamps = [m.header.stamp.to_nsec() for m in odometry]
        np.testing.assert_array_equal(stamps, np.rint(core.time * 1e9))
        core.to_csv(self.folder / "core.csv")
        self.assertEqual(log.read_bytes(), (self.folder / "core.csv").read_bytes())

    def test_one_command_per_odometry_message_at_its_rate(self):
        urdf = harness.description(rate="100")
        with flight(*LOCKSTEP, urdf=urdf), commander() as send:
            with Recording("/odom", Odometry, act=lambda _: send(HOVER)) as odometry:
                odometry.wait_for_publisher()
                step(200)
                odometry.wait_for_count(21)
            self.assertEqual(diagnostic("commands", lambda count: count >= 20), 21)

    def test_a_command_that_does_not_come_is_reported_and_done_without(self):
        late = ("_lockstep_timeout:=0.2", "_real_time_factor:=1", "_paused:=false")
        with flight(*LOCKSTEP, *late), commander() as send:
            with Recording("/odom", Odometry, act=answer_until(3, send)) as odometry:
                odometry.wait(lambda m: m and m[-1].header.stamp.to_nsec() == 5000000)
            diagnostic("late commands", lambda count: count >= 2)

    def test_without_a_controller_the_plant_waits(self):
        with flight(*LOCKSTEP, "_paused:=false"), Recording("/odom", Odometry) as odometry:
            rospy.sleep(1.5)
            self.assertEqual(odometry.messages, [])
            with commander() as send:
                odometry.wait_for_count(1)
                send(HOVER)
                odometry.wait_for_count(2)


if __name__ == "__main__":
    harness.run("lockstep", TestLockstep)
