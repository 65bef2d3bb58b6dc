#!/usr/bin/env python3
"""Send the commands of a recording again, one for each odometry message.

``rosrun quadcore bag_player.py flight.bag [_topic:=/quadrotor/vel_cmd]`` answers the first message
with the first command, and so on, at any time of either. With a plant in lockstep, the flight is
bit-identical to the recorded one.
"""

import sys
import threading

import rospy
from nav_msgs.msg import Odometry
from recorded_commands import read_commands
from std_msgs.msg import Float64MultiArray


class Player:
    """Answers each odometry message with the next command."""

    def __init__(self, commands, topic):
        self.commands = commands
        self.sent = 0
        self.finished = threading.Event()
        self._answered = None  # stamp of the last answered message
        self._publisher = rospy.Publisher(
            topic, Float64MultiArray, queue_size=1000, tcp_nodelay=True
        )
        self._subscriber = rospy.Subscriber("odom", Odometry, self.answer, tcp_nodelay=True)

    def answer(self, message):
        """Send the next command; a repeated message gets the same command again."""
        if message.header.stamp != self._answered:
            self._answered = message.header.stamp
            self.sent += 1
        if self.sent > len(self.commands):
            self.finished.set()
        else:
            self._publisher.publish(data=self.commands[self.sent - 1])


def main():
    """Send the commands of a file."""
    arguments = rospy.myargv()[1:]
    if len(arguments) != 1:
        sys.exit(__doc__)
    rospy.init_node("bag_player", disable_rostime=True)  # the clock stops during a pause
    if rospy.is_shutdown():  # while it waited for the master
        return
    topic = rospy.get_param("~topic", "")
    try:
        topic, commands = read_commands(arguments[0], topic)
    except ValueError as error:
        sys.exit(f"error: {error}")
    player = Player(commands, topic)
    rospy.loginfo("%s: %d commands for %s", arguments[0], len(commands), topic)
    while not rospy.is_shutdown() and not player.finished.wait(0.1):
        pass
    rospy.loginfo("%s: %d commands sent", arguments[0], min(player.sent, len(commands)))


main()
