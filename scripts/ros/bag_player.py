#!/usr/bin/env python3
"""Fly the commands of a recording again, one for each odometry message.

``rosrun quadcore bag_player.py flight.bag [_topic:=/quadrotor/vel_cmd]`` sends the first command
in answer to the first message, and so on, whatever the time of either. Against a plant in lockstep
that flies the recorded flight again, to the last digit.
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
        self._answered = None  # stamp of the message that was answered last
        self._publisher = rospy.Publisher(
            topic, Float64MultiArray, queue_size=1000, tcp_nodelay=True
        )
        self._subscriber = rospy.Subscriber("odom", Odometry, self.answer, tcp_nodelay=True)

    def answer(self, message):
        """Send a command; a message that is sent again gets the same one again."""
        if message.header.stamp != self._answered:
            self._answered = message.header.stamp
            self.sent += 1
        if self.sent > len(self.commands):
            self.finished.set()
        else:
            self._publisher.publish(data=self.commands[self.sent - 1])


def main():
    """Play a file."""
    arguments = rospy.myargv()[1:]
    if len(arguments) != 1:
        sys.exit(__doc__)
    rospy.init_node("bag_player", disable_rostime=True)  # a paused flight's clock stands
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
