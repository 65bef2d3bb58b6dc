#!/usr/bin/env python3
"""Pause, step and reset a flight with the buttons of a joystick, because rviz has no such buttons.

``rosrun quadcore flight_buttons.py [_pause:=7] [_step:=0] [_reset:=6] [_steps:=100]`` reads buttons
from topic ``joy``. One pauses and resumes the flight, one makes some steps of a paused flight, and
one resets it. Set `_paused:=true` if the flight is paused when this node starts.
"""

import rospy
from quadcore.srv import Step
from sensor_msgs.msg import Joy
from std_srvs.srv import Empty


class Buttons:
    """Calls a service when a button is pressed."""

    def __init__(self):
        self._paused = bool(rospy.get_param("~paused", False))
        self._steps = int(rospy.get_param("~steps", 100))
        self._acts = {
            int(rospy.get_param("~pause", 7)): self._pause,
            int(rospy.get_param("~step", 0)): self._step,
            int(rospy.get_param("~reset", 6)): lambda: call("/gazebo/reset_simulation"),
        }
        self._down = set()
        self._subscriber = rospy.Subscriber("joy", Joy, self.take, queue_size=10)

    def take(self, message):
        """Act on the buttons that were released before."""
        down = {i for i, button in enumerate(message.buttons) if button}
        for button in sorted(down - self._down):
            act = self._acts.get(button)
            try:
                if act:
                    act()
            except rospy.ServiceException as error:
                rospy.logwarn("%s", error)
        self._down = down

    def _pause(self):
        call("/gazebo/unpause_physics" if self._paused else "/gazebo/pause_physics")
        self._paused = not self._paused

    def _step(self):
        answer = rospy.ServiceProxy("quadcore/step", Step)(self._steps)
        self._paused = True  # a step pauses the flight
        if not answer.success:
            rospy.logwarn("%s", answer.message)


def call(service):
    """Call a service without arguments."""
    rospy.ServiceProxy(service, Empty)()


if __name__ == "__main__":
    rospy.init_node("flight_buttons", disable_rostime=True)
    if not rospy.is_shutdown():  # as after Ctrl-C without a master
        Buttons()
        rospy.spin()
