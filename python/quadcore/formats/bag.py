"""Bags of ROS 1 and ROS 2 with the topics of the node and the rows of the log."""

from __future__ import annotations

import contextlib
import os
from inspect import signature
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Sequence, Tuple

import numpy as np

from .._core import InputError, QuadcoreError, log_columns
from ..support import interrupts
from ..support.input_files import check_regular
from ..support.optional_packages import require_package
from ..support.output_files import atomic_write, make_write_error, name_temporary
from ..support.rotation import to_yaw
from .bag_messages import ARRAY, Messages
from .rows import (
    LogRows,
    Table,
    check_log_columns,
    check_log_rows,
    find_wrench_terms,
    list_wrench_columns,
)
from .whole_log import DeferredLogFile

LOG = "/quadcore/log"
"""Topic of the log rows. Its first label contains the columns, the others the ignored parts."""

ROS2 = ".ros2"
"""Suffix of ROS 2 bags that quadcore writes; it can also read folders with other names."""

_ON_A_WALL = 1e6  # s; later times are wall-clock times, and count from the start of the bag


def read_commands(path: Path, names: Sequence[str]) -> Table:
    """Read the commands from the only topic with a name that ends in vel_cmd.

    Raises
    ------
    InputError
        If no topic or several topics match, or a message has another length.
    """
    with open_bag(path) as bag:
        found = [c for c in bag.connections if c.topic.endswith("vel_cmd") and c.msgtype == ARRAY]
        topics = sorted({connection.topic for connection in found})
        if len(topics) != 1:
            raise InputError(
                f"{path}: topics of commands: {', '.join(topics) or 'none'}. Record one topic that "
                "ends in vel_cmd, std_msgs/Float64MultiArray."
            )
        start = bag.start_time if bag.start_time > _ON_A_WALL * 1e9 else 0
        rows: Dict[int, np.ndarray] = {}  # of messages with the same time, the last one is kept
        for time, message in read_messages(bag, found):
            speeds = np.asarray(message.data, dtype=float)
            if len(speeds) != len(names) - 1:
                raise InputError(
                    f"{path}: {topics[0]}: a message of {len(speeds)} numbers, but the model has "
                    f"{len(names) - 1} rotors. Record {', '.join(names[1:])}."
                )
            # The first message may be a nanosecond late; see write_log.
            rows[max(0, time - start - (time == 1))] = speeds
        table = np.array([[time / 1e9, *speeds] for time, speeds in sorted(rows.items())])
    return Table(table.reshape(-1, len(names)), lambda row: f"{path}: message {1 + row}", "")


def read_path(path: Path) -> np.ndarray:
    """Read the path of a vehicle: t (s), x, y, z (m) and yaw (rad); shape (rows, 5)."""
    rows = read_log(path).rows
    yaw = np.unwrap(to_yaw(rows[:, 4:8]))
    return np.column_stack([rows[:, :4], yaw])


def read_log(path: Path) -> LogRows:
    """Read a bag written by `write_log` or by the ROS node.

    A bag of the node gives one row for each time that has both true odometry and rotor speeds.

    Raises
    ------
    InputError
        If the bag is damaged or contains no log.
    """
    with open_bag(path) as bag:
        whole = [c for c in bag.connections if c.topic == LOG and c.msgtype == ARRAY]
        columns, rows, ignored = (
            _read_whole_rows(bag, whole) if whole else _read_node_rows(path, bag)
        )
    of_state = check_log_columns(f"{path}", columns)
    check_log_rows(lambda row: f"{path}: row {1 + row}", rows, of_state)
    terms = find_wrench_terms(columns)
    own = len(columns) - 6 * len(terms)
    wrenches = {name: rows[:, own + 6 * i :][:, :6] for i, name in enumerate(terms)}
    return LogRows(columns[:own], rows[:, :own], wrenches, ignored)


def _read_whole_rows(bag: Any, found: Sequence[Any]) -> Tuple[List[str], np.ndarray, List[str]]:
    messages = [message for _, message in read_messages(bag, found)]
    labels = [dimension.label for dimension in messages[0].layout.dim] if messages else []
    if not labels:
        raise InputError(
            f"{bag.path}: {LOG} does not name its columns. Use a bag that quadcore wrote."
        )
    return labels[0].split(","), np.array([m.data for m in messages], dtype=float), labels[1:]


def _read_node_rows(path: Path, bag: Any) -> Tuple[List[str], np.ndarray, List[str]]:
    odometry = _read_stamps(
        bag, _find_topic(path, bag, "nav_msgs/msg/Odometry", "ground_truth/odometry")
    )
    joints = _read_stamps(bag, _find_topic(path, bag, "sensor_msgs/msg/JointState", "joint_states"))
    stamps = sorted(set(odometry) & set(joints))
    if not stamps:
        raise InputError(f"{path}: no time has both a ground_truth/odometry and a joint_states")
    step = int(np.gcd.reduce([*_read_clock(bag), *stamps])) or 1
    rows, rotors = [], len(joints[stamps[0]].velocity)
    for stamp in stamps:
        pose, twist = odometry[stamp].pose.pose, odometry[stamp].twist.twist
        q = pose.orientation
        if len(joints[stamp].velocity) != rotors:
            raise InputError(
                f"{path}: joint_states: {rotors} joints at first, {len(joints[stamp].velocity)} at "
                f"t = {stamp / 1e9:g} s. Record flights of different vehicles separately."
            )
        rows.append([
            stamp // step * (step / 1e9),  # as the simulation computes times
            *_list_vector(pose.position), *_list_vector(q), q.w,
            *_list_vector(twist.linear), *_list_vector(twist.angular),
            *joints[stamp].velocity,
        ])  # fmt: skip
    return log_columns(rotors), np.array(rows), []


def _list_vector(vector: Any) -> Tuple[float, float, float]:
    return vector.x, vector.y, vector.z


def _find_topic(path: Path, bag: Any, kind: str, name: str) -> List[Any]:
    found = [c for c in bag.connections if c.topic.endswith(name) and c.msgtype == kind]
    topics = sorted({connection.topic for connection in found})
    if len(topics) != 1:
        raise InputError(
            f"{path}: topics that end in {name}: {', '.join(topics) or 'none'}. Record one "
            "ground_truth/odometry and one joint_states with the rotor speeds, or give a .csv or "
            ".mat file with the columns of a log."
        )
    return found


def _read_stamps(bag: Any, found: Sequence[Any]) -> Dict[int, Any]:
    messages = (message for _, message in read_messages(bag, found))
    return {m.header.stamp.sec * 10**9 + m.header.stamp.nanosec: m for m in messages}


def _read_clock(bag: Any) -> List[int]:
    found = [c for c in bag.connections if c.msgtype == "rosgraph_msgs/msg/Clock"]
    return [m.clock.sec * 10**9 + m.clock.nanosec for _, m in read_messages(bag, found)] or [0]


def read_messages(bag: Any, found: Sequence[Any]) -> Iterator[Tuple[int, Any]]:
    """Read the messages of some connections with their times (ns)."""
    if not found:  # rosbags would read all connections
        return
    for connection in () if is_ros2(bag.path) else found:
        written = sorted(bag.indexes[connection.id], key=lambda e: (e.chunk_pos, e.offset))
        times = [entry.time for entry in written]
        if times != sorted(times):
            raise InputError(
                f"{bag.path}: {connection.topic}: its time goes back, as after a reset. Record "
                "each flight in a separate bag."
            )
    messages = Messages(2 if is_ros2(bag.path) else 1)
    for connection, time, data in bag.messages(found):
        yield time, messages.deserialise(data, connection.msgtype)


def is_ros2(path: Path) -> bool:
    """Return whether a path is the folder of a ROS 2 bag."""
    return (path / "metadata.yaml").is_file()


@contextlib.contextmanager
def open_bag(path: Path) -> Iterator[Any]:
    """Open a bag; raise `InputError` if rosbags is missing or the bag is damaged."""
    with require_package("a bag", "rosbags", "bag"):
        from rosbags import rosbag1, rosbag2
    Reader = rosbag2.Reader if is_ros2(path) else rosbag1.Reader
    try:
        if not is_ros2(path):
            check_regular(path)
        with Reader(path) as bag:
            yield bag
    except QuadcoreError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except Exception as error:  # a damaged file can raise any exception
        raise InputError(f"{path}: is no bag that can be read: {error}") from error


def write_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    """Write the messages that the node would publish, and each row of the log to `LOG`."""
    with require_package("a bag", "rosbags", "bag"):
        from rosbags.rosbag1 import Writer
    with _name_temporary(path) as part, atomic_write(path) as stream:
        writer = Writer(part)  # Writer accepts only a path
        writer.set_compression(Writer.CompressionFormat.LZ4)
        writer.compressor = _compress
        with writer as bag:
            _write_rows(bag, Messages(), columns, table, wrenches, ignored)
        with part.open("rb") as written:
            import shutil  # slow to import

            shutil.copyfileobj(written, stream)


def _compress(data: bytes) -> bytes:
    """Compress a part of a bag with the options of rosbag, which cannot read others."""
    from lz4 import frame

    packed: bytes = frame.compress(
        data,
        block_size=frame.BLOCKSIZE_MAX1MB,
        block_linked=False,
        content_checksum=True,
        store_size=False,
    )
    return packed


def write_ros2_log(
    path: Path,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    """Write the messages of `write_log` to a new ROS 2 bag, which is a folder."""
    with require_package("a bag", "rosbags", "bag"):
        from rosbags.rosbag2 import Writer
    if path.exists():
        raise InputError(f"{path}: exists already. Name a new folder.")
    part = name_temporary(path)
    # Newer versions of rosbags require the format version, here that of ROS 2 Humble.
    options: Dict[str, Any] = {"version": 8} if "version" in signature(Writer).parameters else {}
    try:
        part.mkdir()
        with Writer(part / path.name, **options) as bag:  # the files in the folder get its name
            _write_rows(bag, Messages(2), columns, table, wrenches, ignored)
        os.rename(part / path.name, path)
    except OSError as error:
        raise make_write_error(path, error) from error
    finally:
        with interrupts.hold_signals():
            import shutil  # slow to import

            shutil.rmtree(part, ignore_errors=True)


def _write_rows(
    bag: Any,
    messages: Messages,
    columns: Sequence[str],
    table: np.ndarray,
    wrenches: Mapping[str, np.ndarray],
    ignored: Sequence[str],
) -> None:
    names = [*columns, *list_wrench_columns(list(wrenches))]
    layout = messages.make_layout([",".join(names), *ignored], len(names))
    of_node = messages.make_node_messages(columns)
    connections = {
        topic: bag.add_connection(topic, kind, typestore=messages.store)
        for topic, kind in [*of_node.kinds.items(), (LOG, ARRAY)]
    }
    for i, state in enumerate(table):
        acting = [wrench[i : i + 1] for wrench in wrenches.values()]
        row = np.hstack([table[i : i + 1], *acting])[0] if acting else state
        whole = (LOG, state[0], messages.make_array(row, layout))
        for topic, time, data in [*of_node.at(state), whole]:
            # A ROS 1 bag cannot contain a message at time 0.
            bag.write(connections[topic], max(1, round(time * 1e9)), data)


@contextlib.contextmanager
def _name_temporary(path: Path) -> Iterator[Path]:
    """Provide the path of a temporary file that is unique to this process."""
    part = name_temporary(path, ".rows")
    with contextlib.suppress(FileNotFoundError):
        part.unlink()
    try:
        yield part
    except OSError as error:
        raise make_write_error(path, error) from error
    finally:
        with interrupts.hold_signals(), contextlib.suppress(OSError):
            part.unlink()


def make_log_file(
    path: Path, columns: Sequence[str], terms: Sequence[str], ignored: Sequence[str]
) -> DeferredLogFile:
    """Make a recorder; raise `InputError` if the package rosbags is missing."""
    Messages()
    write = write_ros2_log if path.suffix.lower() == ROS2 else write_log
    return DeferredLogFile(write, path, columns, terms, ignored)
