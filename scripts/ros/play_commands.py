#!/usr/bin/env python3
"""Send rotor speeds from a file and store the odometry: figure 5.1 of the thesis as a node.

``rosrun quadcore play_commands.py FILE [_topic:=/quadrotor/vel_cmd] [_rotors:=4]
[_lockstep:=true] [_duration:=S] [_out:=odometry.mat]`` sends the rows (t, w1..wn; rad/s) of a .csv
or .mat file or of a bag, each when the odometry has reached its time. With `_lockstep:=true`, it
answers each odometry message with one row. It ends with the last row, or after the duration, and
writes the odometry as a log without rotors, .mat, .csv or .bag.
"""

import sys
import threading
from pathlib import Path

import numpy as np
import rospy
from nav_msgs.msg import Odometry
from recorded_commands import read_table
from std_msgs.msg import Float64MultiArray

from quadcore import InputError
from quadcore._core import log_columns
from quadcore.simulation.log import check_log_path, make_log_file


class Player:
    """Answers odometry with the command of its time."""

    def __init__(self, table, topic, lockstep, end):
        self._table, self._lockstep, self._end = table, lockstep, end
        self._sent = -1
        self.rows = {}  # by stamp, because a message may be repeated
        self.finished = threading.Event()
        self._publisher = rospy.Publisher(
            topic, Float64MultiArray, queue_size=1000, tcp_nodelay=True
        )
        self._subscriber = rospy.Subscriber("odom", Odometry, self.answer, tcp_nodelay=True)

    def answer(self, message):
        """Store the odometry, and send the command of its time."""
        if self.finished.is_set():
            return
        time = message.header.stamp.to_sec()
        self.rows[time] = make_row(time, message)
        due = np.searchsorted(self._table[:, 0], time + 1e-9, side="right") - 1
        has_reader = self._lockstep or self._publisher.get_num_connections() > 0
        if due >= 0 and has_reader and (self._lockstep or due != self._sent):
            self._sent = due
            self._publisher.publish(data=self._table[due, 1:].tolist())
        if time >= self._end - 1e-9:
            self.finished.set()

    def received_rows(self):
        """Return the odometry so far, a row for each message."""
        return np.array([row for _, row in sorted(self.rows.items())])


def make_row(time, message):
    """Return the row of a log: t, pose, twist."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    v, w = message.twist.twist.linear, message.twist.twist.angular
    return [time, p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z]


def main():
    """Send the commands of a file."""
    arguments = rospy.myargv()[1:]
    if len(arguments) != 1:
        sys.exit(__doc__)
    rospy.init_node("play_commands", disable_rostime=True)  # the clock stops during a pause
    if rospy.is_shutdown():  # while it waited for the master
        return
    out = rospy.get_param("~out", "")
    log = None
    try:
        if out:
            check_log_path(out)
            log = make_log_file(Path(out), log_columns(0), (), ())
        table = read_table(arguments[0], int(rospy.get_param("~rotors", 4)))
    except (InputError, ValueError) as error:
        sys.exit(f"error: {error}")
    topic = rospy.get_param("~topic", "/quadrotor/vel_cmd")
    end = float(rospy.get_param("~duration", table[-1, 0]))
    player = Player(table, topic, bool(rospy.get_param("~lockstep", False)), end)
    rospy.loginfo("%s: %d commands for %s", arguments[0], len(table), topic)
    while not rospy.is_shutdown() and not player.finished.wait(0.1):
        pass
    if log is None or not player.rows:
        return
    try:
        log.receive(player.received_rows(), np.empty((len(player.rows), 0, 6)))
        log.close()
    except InputError as error:
        sys.exit(f"error: {error}")
    rospy.loginfo("written %s", out)


main()
