"""What the ROS tests share: nodes as processes, and recordings of topics."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Callable

import rosgraph
import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from gazebo_msgs.srv import GetModelState
from quadcore.srv import Step
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Empty

from quadcore.model.description import load_description

# s; a ceiling for whatever is waited for, on machines that are busy with other things
LONG = 180.0
HOVER = [475.0, -475.0, 475.0, -475.0]  # rad/s, a little more than the weight


@lru_cache(None)
def shipped_description() -> str:
    """URDF of the shipped quadrotor at sim_slow 1."""
    return load_description("quadrotor", {"sim_slow": "1"}).text


def description(**tags: str) -> str:
    """The same with other texts in some plugin tags."""
    text = shipped_description()
    for tag, value in tags.items():
        text, count = re.subn(f"<{tag}>[^<]*<", f"<{tag}>{value}<", text)
        assert count > 0, tag
    return text


def folder_of(test: unittest.TestCase) -> Path:
    """A folder that lasts as long as a test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return Path(folder.name)


@lru_cache(None)
def executable(name: str) -> str:
    """Path of a node of this package."""
    return roslib.packages.find_node("quadcore", name)[0]


class Process:
    """A node in a process of its own, ended with the block."""

    def __init__(self, name: str, *arguments: str, **environment: str) -> None:
        self.process = subprocess.Popen(
            [executable(name), *arguments],
            env={**os.environ, **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            restore_signals=False,  # a file that may not grow is an error, as a full disk is
        )

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.end()

    def end(self, number: int = signal.SIGINT) -> float:
        """Send a signal and return the time (s) until the process has gone."""
        start = time.monotonic()
        self.process.send_signal(number)
        try:
            _, self.error = self.process.communicate(timeout=LONG)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        return time.monotonic() - start

    def result(self) -> tuple[int, str]:
        """Exit status and standard error of a process that ends by itself."""
        _, error = self.process.communicate(timeout=LONG)
        return self.process.returncode, error


@contextmanager
def flight(
    *arguments: str,
    urdf: str | None = None,
    namespace: str = "",
    parameters: dict | None = None,
):
    """A quadcore_node that is ready; `arguments` such as "_paused:=true"."""
    rospy.set_param(f"{namespace}/robot_description", urdf or description())
    if rospy.has_param(f"{namespace}/quadcore"):
        rospy.delete_param(f"{namespace}/quadcore")
    for name, value in (parameters or {}).items():
        rospy.set_param(f"{namespace}/quadcore/{name}", value)
    with Process("quadcore_node", f"__ns:={namespace}", "_z:=10", *arguments) as node:
        rospy.wait_for_service(f"{namespace}/quadcore/set_state", LONG)
        yield node


class Recording:
    """Every message of a topic."""

    def __init__(self, topic: str, message_type: type, act: Callable | None = None) -> None:
        self.messages: list = []
        self._act = act
        self._came = threading.Condition()
        self._subscriber = rospy.Subscriber(topic, message_type, self._take, tcp_nodelay=True)

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *_: object) -> None:
        self._subscriber.unregister()

    def _take(self, message: object) -> None:
        if self._act is not None:
            self._act(message)
        with self._came:
            self.messages.append(message)
            self._came.notify_all()

    def wait(self, until: Callable[[list], bool], seconds: float = LONG) -> list:
        """Messages once there are some and `until` holds of them."""
        with self._came:
            if not self._came.wait_for(lambda: self.messages and until(self.messages), seconds):
                raise AssertionError(f"{self._subscriber.name}: {len(self.messages)} messages")
            return list(self.messages)

    def wait_for_count(self, count: int) -> list:
        """Messages once there are `count`."""
        return self.wait(lambda messages: len(messages) >= count)

    def wait_for_publisher(self) -> Recording:
        """Return once a node sends here.

        What it keeps for newcomers has come then, and is forgotten: nothing that follows is lost.
        """
        self.wait_for_count(1)
        self.messages.clear()
        return self

    def wait_for_connection(self, publishers: int = 1) -> Recording:
        """Return once so many publishers are known here and send here.

        A node of roscpp greets a subscriber a moment before it sends to it.
        """
        wait_until(lambda: self._subscriber.get_num_connections() >= publishers)
        wait_until(lambda: count_senders(self._subscriber.resolved_name) >= publishers)
        return self


@contextmanager
def commander(topic: str = "/quadrotor/vel_cmd", listeners: int = 1):
    """Give a function that sends commands, once so many listen."""
    publisher = rospy.Publisher(topic, Float64MultiArray, queue_size=0, tcp_nodelay=True)
    try:
        wait_until(lambda: publisher.get_num_connections() >= listeners)
        yield lambda speeds: publisher.publish(data=speeds)
    finally:
        publisher.unregister()


def time_of_flight(namespace: str = "") -> rospy.Time:
    """The time that the vehicle has reached; what came before is on its way or there."""
    get = rospy.ServiceProxy(f"{namespace}/gazebo/get_model_state", GetModelState)
    return get("quadrotor", "").header.stamp


def wait_for_status(message: str) -> None:
    """Return once the diagnostics of a flight say so."""
    with Recording("/diagnostics", DiagnosticArray) as recording:
        recording.wait(lambda messages: messages[-1].status[0].message == message)


def step(n: int, namespace: str = "") -> rospy.Time:
    """Fly n steps of a paused flight, to the time returned."""
    response = rospy.ServiceProxy(f"{namespace}/quadcore/step", Step)(n)
    if not response.success:
        raise AssertionError(response.message)
    return response.stamp


def call(service: str) -> None:
    """Call a service without arguments."""
    rospy.ServiceProxy(service, Empty)()


def diagnostic(key: str, until: Callable[[float], bool] = lambda _: True) -> float:
    """Value of a diagnostic, once it is as wanted."""

    def value(messages: list) -> float:
        pairs = messages[-1].status[0].values if messages else []
        return next((float(pair.value) for pair in pairs if pair.key == key), float("nan"))

    with Recording("/diagnostics", DiagnosticArray) as recording:
        known = recording.wait(lambda m: value(m) == value(m) and until(value(m)))
        return value(known)


def ends_within_a_second(start: Callable, number: int) -> None:
    """Check that a node ends well and at once at a signal; `start` makes a block that gives it.

    A busy machine may hold up one that ends. What waits for something holds up all.
    """
    ends = []
    for _ in range(8):
        with start() as node:
            time_taken = node.end(number)
        if time_taken < 1 and node.process.returncode == 0:
            return
        ends.append((time_taken, node.process.returncode, node.error))
    raise AssertionError(f"ended after so many seconds, with that status, saying this: {ends}")


def publishers(topic: str) -> list[str]:
    """Nodes that publish a topic now: one that had no time to take its leave is still listed."""
    master = rosgraph.Master("/test")
    state, _, _ = master.getSystemState()

    def lives(node: str) -> bool:
        try:
            xmlrpc.client.ServerProxy(master.lookupNode(node)).getPid("/test")
        except (OSError, rosgraph.MasterException):
            return False
        return True

    return [node for node in dict(state).get(topic, []) if lives(node)]


def outcome(*arguments, **environment):
    """Exit status and standard error of a node that refuses to start."""
    with Process("quadcore_node", *arguments, **environment) as node:
        return node.result()


def count_senders(topic: str) -> int:
    """Return how many nodes send a topic to this one, as they report themselves."""
    me = rospy.get_name()
    master = rosgraph.Master(me)
    count = 0
    for node in dict(master.getSystemState()[0]).get(topic, []):
        with suppress(OSError, rosgraph.MasterException):  # one that has gone
            _, _, connections = xmlrpc.client.ServerProxy(master.lookupNode(node)).getBusInfo(me)
            count += any(to[1] == me and to[2] == "o" and to[4] == topic for to in connections)
    return count


def wait_until(condition: Callable[[], bool], seconds: float = LONG) -> None:
    """Return once `condition` holds."""
    limit = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError("waited in vain")
        time.sleep(0.02)


def run(name: str, case: type[unittest.TestCase]) -> None:
    """Run the tests of a class as a rostest."""
    # The node under test makes the time; a test follows the clock on the wall.
    rospy.init_node(name, disable_rostime=True)
    rostest.rosrun("quadcore", name, case, sys.argv)
