#!/usr/bin/env python3
"""Lockstep: the same flight whatever the controller's pace, and nothing added to the physics."""

import random
import time
import unittest

import harness
import numpy as np
from harness import HOVER, Recording, call, commander, diagnostic, flight, step
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

import quadcore as qc

STEPS = 1500
LOCKSTEP = (
    "_paused:=true",
    "_lockstep:=true",
    "_real_time_factor:=0",
    "_lockstep_timeout:=30",  # a busy machine is no fault
)
TIMEOUT = "_lockstep_timeout:=10"  # no answer takes so long, and tests that wait for it end


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


def fly_with(act, steps, *arguments):
    """Odometry of a flight of so many steps with a controller `act(message, send)`."""
    with flight(*LOCKSTEP, *arguments), commander() as send:

        def answer(message):
            act(message, send)

        with Recording("/odom", Odometry, act=answer) as odometry:
            odometry.wait_for_connection()
            step(steps)
            return odometry.wait_for_count(steps + 1)


def fly(controller, steps, *arguments):
    """The same with a controller that gives a command for a message."""
    return fly_with(lambda message, send: send(controller(message)), steps, *arguments)


def tick(message):
    """Steps since the start."""
    return round(message.header.stamp.to_sec() * 1000)


def random_commands(steps):
    """A table of commands, another one for each step."""
    speeds = HOVER + np.random.default_rng(2).uniform(-20, 20, (steps, 4))
    return np.column_stack([np.arange(steps) * 0.001, speeds])


class TestLockstep(unittest.TestCase):
    def setUp(self):
        self.folder = harness.folder_of(self)

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
        table = random_commands(STEPS)
        log = self.folder / "ros.csv"
        odometry = fly(lambda m: table[min(tick(m), STEPS - 1), 1:], STEPS, f"_log:={log}")
        core = self.assert_flown(odometry, table)
        stamps = [m.header.stamp.to_nsec() for m in odometry]
        np.testing.assert_array_equal(stamps, np.rint(core.time * 1e9))
        core.to_csv(self.folder / "core.csv")
        self.assertEqual(log.read_bytes(), (self.folder / "core.csv").read_bytes())

    def assert_flown(self, odometry, table):
        """Whether the odometry is that of the core with these commands, to the last digit."""
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        core = simulation.run((len(odometry) - 1) * 0.001, table)
        np.testing.assert_array_equal([row(m) for m in odometry], core.table[:, 1:14])
        return core

    def test_after_a_reset_the_answer_on_its_way_is_not_taken_for_that_to_the_start(self):
        table = random_commands(101)
        for answers_the_old_message in (True, False):
            jumps = []

            def act(message, send, jumps=jumps, answers=answers_the_old_message):
                if tick(message) == 20 and not jumps:
                    jumps.append(message)
                    call("/gazebo/reset_simulation")
                    if not answers:
                        return
                send(table[tick(message), 1:])

            with self.subTest(answers_the_old_message=answers_the_old_message):
                odometry = fly_with(act, 120, TIMEOUT)
                self.assertEqual([tick(m) for m in odometry[20:23]], [20, 0, 1])
                self.assert_flown(odometry[21:], table[:100])

    def test_after_a_late_answer_the_later_ones_are_in_time(self):
        table = random_commands(101)
        flown = table[:100].copy()
        flown[50, 1:] = flown[49, 1:]
        for comes in (True, False):  # late, or never

            def act(message, send, comes=comes):
                if tick(message) == 50:
                    if not comes:
                        return
                    diagnostic("late commands", lambda count: count == 1)
                send(table[tick(message), 1:])

            with self.subTest(comes=comes):
                odometry = fly_with(act, 100, TIMEOUT)
                self.assert_flown(odometry, flown)

    def test_one_command_per_odometry_message_at_its_rate(self):
        urdf = harness.description(rate="100")
        with flight(*LOCKSTEP, urdf=urdf), commander() as send:
            with Recording("/odom", Odometry, act=lambda _: send(HOVER)) as odometry:
                odometry.wait_for_connection()
                step(200)
                odometry.wait_for_count(21)
            self.assertEqual(diagnostic("commands", lambda count: count >= 21), 21)

    def test_a_command_that_does_not_come_is_reported_and_done_without(self):
        late = ("_lockstep_timeout:=0.2", "_real_time_factor:=1", "_paused:=false")
        with flight(*LOCKSTEP, *late), commander() as send:
            with Recording("/odom", Odometry, act=answer_until(3, send)) as odometry:
                odometry.wait(lambda m: m and m[-1].header.stamp.to_nsec() >= 5000000)
            diagnostic("late commands", lambda count: count >= 2)

    def test_surplus_commands_wait_in_order_for_their_messages(self):
        table = random_commands(1000)
        sent = []

        def in_pairs(message, send):
            for _ in range(2):
                if len(sent) < len(table):
                    sent.append(message)
                    send(table[len(sent) - 1, 1:])

        self.assert_flown(fly_with(in_pairs, 1000), table)

    def test_a_sender_at_a_rate_of_its_own_loses_no_command(self):
        table = random_commands(3000)
        with flight(*LOCKSTEP, "_paused:=false"), commander() as send:
            for command in table[:, 1:]:
                send(command)
            with Recording("/odom", Odometry) as odometry:
                final = odometry.wait(lambda m: m and tick(m[-1]) == len(table))[-1]
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        core = simulation.run(len(table) * 0.001, table)
        self.assertEqual(row(final), list(core.table[-1, 1:14]))

    def test_a_node_as_simulink_generates_them_loses_no_command(self):
        steps = np.arange(2000)
        speeds = [470 + 0.5 * ((steps * (rotor + 3)) % 11) for rotor in range(4)]
        signed = np.array(speeds) * np.array([[1], [-1], [1], [-1]])
        table = np.column_stack([steps * 0.001, signed.T])
        with flight(*LOCKSTEP, "_paused:=false"), Recording("/odom", Odometry) as odometry:
            with harness.Process("simulink_stand_in", str(len(table))):
                final = odometry.wait(lambda m: m and tick(m[-1]) == len(table))[-1]
            self.assertEqual(diagnostic("commands", lambda count: count >= len(table)), len(table))
            self.assertEqual(diagnostic("rejected commands"), 0)
        simulation = qc.Simulation("quadrotor", xacro_args={"sim_slow": 1})
        core = simulation.run(len(table) * 0.001, table)
        self.assertEqual(row(final), list(core.table[-1, 1:14]))

    def test_too_many_surplus_commands_are_refused_and_counted(self):
        with flight(*LOCKSTEP) as node, commander() as send:
            for sent in range(1, 10004):  # a paused flight takes none of them
                send(HOVER)
                if sent % 1000 == 0:  # before roscpp's own queue is full
                    diagnostic("waiting commands", lambda count, sent=sent: count == sent)
            diagnostic("rejected commands", lambda count: count == 3)
            node.end()
        self.assertIn("10000 commands already wait for odometry", node.error)

    def test_before_anyone_can_answer_the_start_is_seen(self):
        topics = Recording("/clock", Clock), Recording("/tf", TFMessage)
        with flight(*LOCKSTEP), topics[0] as clock, topics[1] as tf:
            self.assertEqual(clock.wait_for_count(1)[0].clock.to_nsec(), 0)
            pose = tf.wait_for_count(1)[0].transforms[0].transform
        self.assertEqual(pose.translation.z, 10)

    def test_without_a_controller_the_plant_waits(self):
        with flight(*LOCKSTEP, "_paused:=false"), Recording("/odom", Odometry) as odometry:
            harness.wait_for_status("waiting for a command on /quadrotor/vel_cmd")
            self.assertEqual(diagnostic("steps"), 0)
            with commander() as send:
                odometry.wait_for_count(1)
                send(HOVER)
                odometry.wait(lambda m: tick(m[-1]) == 1)


if __name__ == "__main__":
    harness.run("lockstep", TestLockstep)
