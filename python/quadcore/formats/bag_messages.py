"""Messages of ROS 1 or ROS 2 as bytes, made from the rows of a log."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np

from .._core import log_columns
from ..support.optional_packages import require_package

ARRAY = "std_msgs/msg/Float64MultiArray"
_CLOCK = "rosgraph_msgs/msg/Clock"
_ODOMETRY = "nav_msgs/msg/Odometry"
_JOINTS = "sensor_msgs/msg/JointState"
_TF = "tf2_msgs/msg/TFMessage"
_LEAST_VARIANCE = 1e-12  # same as in the node
_SLOW_RATE = 50  # 1/s; rate of clock, tf and joint states in a ROS 1 bag, as in the node


class NodeMessages(NamedTuple):
    """Messages of the node: types by topic, and at(row), which yields topic, time (s) and bytes."""

    kinds: Dict[str, str]
    at: Any


class Messages:
    """Serialiser and deserialiser of messages.

    Parameters
    ----------
    ros
        Version of ROS, 1 or 2. Both versions use the same message names.

    Raises
    ------
    InputError
        If the package rosbags is missing.
    """

    def __init__(self, ros: int = 1) -> None:
        with require_package("a bag", "rosbags", "bag"):
            from rosbags.typesys import Stores, get_types_from_msg, get_typestore
        self.store = get_typestore(Stores.ROS2_HUMBLE if ros == 2 else Stores.ROS1_NOETIC)
        self._serialise = self.store.serialize_cdr if ros == 2 else self.store.serialize_ros1
        self.deserialise = self.store.deserialize_cdr if ros == 2 else self.store.deserialize_ros1
        self._sequence = () if ros == 2 else (0,)  # sequence number, which ROS 2 lacks
        if _TF not in self.store.types:  # it is not a type of common_msgs
            self.store.register(
                get_types_from_msg("geometry_msgs/TransformStamped[] transforms", _TF)
            )

    def make_layout(self, labels: Sequence[str], size: int) -> Any:
        """Make the layout of an array with these labels of its dimensions."""
        dimension = self._type("std_msgs/msg/MultiArrayDimension")
        sizes = [size, *[1] * (len(labels) - 1)]
        dimensions = [dimension(label, n, n) for label, n in zip(labels, sizes)]
        return self._type("std_msgs/msg/MultiArrayLayout")(dimensions, 0)

    def make_array(self, numbers: np.ndarray, layout: Any) -> bytes:
        """Make a message with an array of numbers."""
        return self._bytes(self._type(ARRAY)(layout, np.array(numbers, dtype=float)), ARRAY)

    def make_node_messages(self, columns: Sequence[str]) -> NodeMessages:
        """Return the converter from rows with these columns to the messages of the node."""
        rotors = sum("." not in column for column in columns) - len(log_columns(0))
        topics: Dict[str, List[int]] = {}
        for i, column in enumerate(columns):
            topic, is_topic, _ = column.partition(".")
            if is_topic:
                topics.setdefault(topic, []).append(i)
        kinds = {
            "/clock": _CLOCK,
            "/ground_truth/odometry": _ODOMETRY,
            "/tf": _TF,
            "/joint_states": _JOINTS,
        }
        layouts = {}
        for topic, places in topics.items():
            fields = [columns[i].partition(".")[2] for i in places if not _is_stamp(columns[i])]
            kinds[f"/{topic}"] = _ODOMETRY if fields == _FIELDS else ARRAY
            layouts[topic] = self.make_layout([", ".join(fields)], len(fields))
        sent: Dict[str, float] = {}  # last stamp of each topic
        counted = -1  # number of periods of the slow messages

        def at(row: np.ndarray) -> Iterator[Tuple[str, float, bytes]]:
            nonlocal counted
            stamp = self._stamp(row[0])
            yield "/ground_truth/odometry", row[0], self._odometry(stamp, row[1:14], [0.0] * 4)
            count = int(row[0] * _SLOW_RATE + 1e-6)
            if count != counted or not self._sequence:  # ROS 2 bags contain them for each row
                counted = count
                yield "/clock", row[0], self._bytes(self._type(_CLOCK)(stamp), _CLOCK)
                yield "/tf", row[0], self._transform(stamp, row[1:8])
                yield "/joint_states", row[0], self._joint_states(stamp, row[14 : 14 + rotors])
            for topic, places in topics.items():
                values = row[places]
                has_stamp = _is_stamp(columns[places[0]])
                when = values[0] if has_stamp else row[0]
                numbers = values[1:] if has_stamp else values
                if np.isnan(when) or sent.get(topic) == when:
                    continue
                sent[topic] = when
                if kinds[f"/{topic}"] == _ODOMETRY:
                    data = self._odometry(self._stamp(when), numbers[:13], numbers[13:].tolist())
                else:
                    data = self.make_array(numbers, layouts[topic])
                yield f"/{topic}", when, data

        return NodeMessages(kinds, at)

    def _type(self, name: str) -> Any:
        return self.store.types[name]

    def _bytes(self, message: Any, kind: str) -> bytes:
        return bytes(self._serialise(message, kind))

    def _stamp(self, time: float) -> Any:
        seconds, rest = divmod(round(time * 1e9), 10**9)
        return self._type("builtin_interfaces/msg/Time")(seconds, rest)

    def _header(self, stamp: Any, frame: str) -> Any:
        return self._type("std_msgs/msg/Header")(*self._sequence, stamp, frame)

    def _vector(self, numbers: np.ndarray, kind: str = "Vector3") -> Any:
        return self._type(f"geometry_msgs/msg/{kind}")(*numbers)

    def _odometry(self, stamp: Any, state: np.ndarray, variances: Sequence[float]) -> bytes:
        """Make an odometry message from the values x ... qw, vx ... wz."""
        pose = self._type("geometry_msgs/msg/Pose")(
            self._vector(state[:3], "Point"), self._vector(state[3:7], "Quaternion")
        )
        twist = self._type("geometry_msgs/msg/Twist")(
            self._vector(state[7:10]), self._vector(state[10:13])
        )
        covariances = [
            np.diag(np.maximum(np.repeat(pair, 3), _LEAST_VARIANCE)).ravel()
            for pair in (variances[:2], variances[2:])
        ]
        message = self._type(_ODOMETRY)(
            self._header(stamp, "world"),
            "drone",
            self._type("geometry_msgs/msg/PoseWithCovariance")(pose, covariances[0]),
            self._type("geometry_msgs/msg/TwistWithCovariance")(twist, covariances[1]),
        )
        return self._bytes(message, _ODOMETRY)

    def _transform(self, stamp: Any, pose: np.ndarray) -> bytes:
        transform = self._type("geometry_msgs/msg/Transform")(
            self._vector(pose[:3]), self._vector(pose[3:], "Quaternion")
        )
        stamped = self._type("geometry_msgs/msg/TransformStamped")(
            self._header(stamp, "world"), "drone", transform
        )
        return self._bytes(self._type(_TF)([stamped]), _TF)

    def _joint_states(self, stamp: Any, rates: np.ndarray) -> bytes:
        names = [f"j{i}" for i in range(1, 1 + len(rates))]
        nothing = np.empty(0)
        message = self._type(_JOINTS)(
            self._header(stamp, ""), names, nothing, np.array(rates, dtype=float), nothing
        )
        return self._bytes(message, _JOINTS)


def _is_stamp(column: str) -> bool:
    return column.endswith(".stamp")


_FIELDS = [
    *log_columns(0)[1:],
    "position_variance",
    "orientation_variance",
    "linear_velocity_variance",
    "angular_velocity_variance",
]
"""Fields of an odometry message."""
