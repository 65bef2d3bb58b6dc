#!/usr/bin/env python3
"""Each shipped vehicle has all its links in tf, and tf gets no transform twice."""

import unittest
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

import harness
import rospkg
from harness import Recording, flight, step
from tf2_msgs.msg import TFMessage

from quadcore.model.description import load_description

STEPS = 50
VEHICLES = sorted((Path(rospkg.RosPack().get_path("quadcore")) / "urdf").glob("*.urdf.xacro"))


def transforms(messages):
    return [transform for message in messages for transform in message.transforms]


class TestVehicles(unittest.TestCase):
    def fly(self, urdf):
        """Parents and stamps of the frames of a vehicle that flies with a window."""
        topics = Recording("/tf", TFMessage), Recording("/tf_static", TFMessage)
        shown = flight("_paused:=true", "_rotor_tf:=true", urdf=urdf)
        with topics[0] as moving, topics[1] as still, shown:
            still.wait_for_count(1)
            moving.wait_for_count(1)
            end = step(STEPS)
            moving.wait(lambda m: any(t.header.stamp == end for t in m[-1].transforms))
        parents, stamps = {}, defaultdict(list)
        for transform in transforms([*moving.messages, *still.messages]):
            parents[transform.child_frame_id] = transform.header.frame_id
        for transform in transforms(moving.messages):
            stamps[transform.child_frame_id].append(transform.header.stamp)
        return parents, stamps

    def test_there_are_nine(self):
        self.assertEqual(len(VEHICLES), 9)

    def test_all_links_are_in_one_tree_and_no_transform_is_repeated(self):
        for vehicle in VEHICLES:
            with self.subTest(vehicle.name):
                urdf = load_description(str(vehicle), {}).text
                parents, stamps = self.fly(urdf)
                links = {link.get("name") for link in ElementTree.fromstring(urdf).iter("link")}
                self.assertLessEqual(links, set(parents))
                for link in links:
                    while link in parents:
                        link = parents[link]
                    self.assertEqual(link, "world")
                for child, times in stamps.items():
                    # tf2 warns with TF_REPEATED_DATA of a stamp that a frame has had.
                    self.assertEqual(times, sorted(set(times)), child)


if __name__ == "__main__":
    harness.run("vehicles", TestVehicles)
