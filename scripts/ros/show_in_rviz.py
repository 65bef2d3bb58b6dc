#!/usr/bin/env python3
"""Run rviz with the frames of a vehicle: ``show_in_rviz.py FILE.rviz [ARGUMENT ...]``.

rviz reads names of frames only from its file. This script waits until the vehicle's node has set
the parameter ``vehicle_frames`` in its namespace, puts these names into the file's settings, and
becomes rviz.
"""

import os
import sys
import time

import rospy
import yaml


def wait_for_frames():
    """Return the frames of the vehicle of this namespace."""
    while True:
        frames = rospy.get_param("vehicle_frames", None)
        if frames:
            return frames
        time.sleep(0.1)


def set_frames(settings, frames):
    """Put the names into the settings of rviz."""
    manager = settings["Visualization Manager"]
    manager["Global Options"]["Fixed Frame"] = frames["fixed"]
    manager["Views"]["Current"]["Target Frame"] = frames["vehicle"]
    for display in manager["Displays"]:
        if "Reference Frame" in display:
            display["Reference Frame"] = frames["fixed"]
        if "TF Prefix" in display:
            display["TF Prefix"] = frames["prefix"]
        if "Frames" in display:
            shown = {frames[name]: {"Value": True} for name in ("fixed", "world", "vehicle")}
            display["Frames"] = {"All Enabled": False, **shown}


def main():
    """Become rviz."""
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    path, *arguments = sys.argv[1:]
    with open(path, encoding="utf-8") as file:
        settings = yaml.safe_load(file)
    set_frames(settings, wait_for_frames())
    # A file in memory needs no removal when rviz ends.
    copy = os.memfd_create("quadcore.rviz", 0)
    os.write(copy, yaml.safe_dump(settings).encode())
    os.execvp("rosrun", ["rosrun", "rviz", "rviz", "-d", f"/proc/self/fd/{copy}", *arguments])


main()
