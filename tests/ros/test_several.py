#!/usr/bin/env python3
"""Several vehicles in namespaces fly on one clock, and each is its own."""

import unittest

import harness
import numpy as np
from harness import LONG, Recording, call
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

VEHICLES = ("uav1", "uav2", "uav3")
SECONDS = 60  # of simulation
STEP = 2000000  # ns, as several.test sets it


def time_of(message):
    return message.header.stamp.to_sec()


def height(message):
    return message.pose.pose.position.z


class TestSeveral(unittest.TestCase):
    def test_three_fly_for_a_minute(self):
        clock = Recording("/clock", Clock)
        tf, static = Recording("/tf", TFMessage), Recording("/tf_static", TFMessage)
        flights = {name: Recording(f"/{name}/odom", Odometry) for name in VEHICLES}
        begin = max(time_of(flight.wait_for_count(1)[0]) for flight in flights.values())
        for name, flight in flights.items():
            flight.wait(lambda m: height(m[-1]) > 0.9)
            call(f"/{name}/gazebo/reset_simulation")
        end = begin + SECONDS
        clock.wait(lambda m: m[-1].clock.to_sec() > end, 5 * LONG)
        for flight in flights.values():
            flight.wait(lambda m: time_of(m[-1]) > end - 0.1, 5 * LONG)

        self.assertEqual(len(harness.publishers("/clock")), 1)
        ticks = np.array([m.clock.to_nsec() for m in list(clock.messages)])
        self.assertGreaterEqual(np.diff(ticks).min(), 0)
        np.testing.assert_array_equal(ticks % STEP, 0)

        parents = {}
        for message in list(tf.messages) + static.messages:
            for transform in message.transforms:
                parents.setdefault(transform.child_frame_id, set()).add(transform.header.frame_id)
        expected = {f"{name}/drone": {"world"} for name in VEHICLES}
        expected.update({f"{name}/frame": {f"{name}/drone"} for name in VEHICLES})
        self.assertEqual(parents, expected)

        for i, (name, flight) in enumerate(flights.items()):
            messages = list(flight.messages)
            self.assertEqual({m.child_frame_id for m in messages}, {f"{name}/drone"})
            stamps = np.array([m.header.stamp.to_nsec() for m in messages])
            self.assertGreaterEqual(np.diff(stamps).min(), 0)
            # Each is a time of the clock's; on a busy machine a tick may have been lost on its way.
            known = stamps[(stamps > ticks[0]) & (stamps < ticks[-1])]
            self.assertGreater(known.size, 90 * SECONDS)
            unseen = known[~np.isin(known, ticks)]
            after = np.searchsorted(ticks, unseen)
            np.testing.assert_array_less(STEP, ticks[after] - ticks[after - 1])
            np.testing.assert_array_equal(unseen % STEP, 0)
            self.assertAlmostEqual(messages[-1].pose.pose.position.y, 2 * i, delta=0.5)
            # Its own reset put it back to the start, once; those of the others did not.
            pairs = zip(messages, messages[1:])
            jumps = [time_of(b) for a, b in pairs if height(a) > 0.5 and height(b) == 0.1]
            self.assertEqual(len(jumps), 1, name)
            self.assertAlmostEqual(height(messages[-1]), 1, delta=0.05)


if __name__ == "__main__":
    harness.run("several", TestSeveral)
