"""Read recorded commands from a file."""

from pathlib import Path

TYPE = "std_msgs/Float64MultiArray"


def read_table(path, rotors):
    """Read commands with their times: an array of rows t (s), w1..wn (rad/s).

    Raises `ValueError`, or quadcore's `InputError`, with one line.
    """
    if not str(path).endswith(".bag"):
        from quadcore.simulation.commands import read_commands as read_file

        return read_file(path, rotors)
    from quadcore.simulation.commands import check_commands

    _, times, commands = _read_recorded(path, "")
    rows = dict(zip(times, commands))  # the last one of each time
    if any(len(row) != rotors for row in commands):
        raise ValueError(
            f"{path}: contains commands that are not for {rotors} rotors. Set _rotors:=N."
        )
    return check_commands([[time, *row] for time, row in sorted(rows.items())], rotors)


def read_commands(path, topic=""):
    """Read a bag's commands in the order in which they were recorded.

    Returns the topic's name and a list of rotor speeds (rad/s) for each command. `topic` is by
    default the only topic that ends in ``vel_cmd``. Raises `ValueError` if it does not exist.
    """
    name, _, commands = _read_recorded(path, topic)
    return name, commands


def _read_recorded(path, topic):
    """Return the topic's name, and the time (s) and the speeds of each message."""
    import rosbag

    if not Path(path).is_file():
        raise ValueError(f"{path}: does not exist. Name a bag with the topic vel_cmd.")
    try:
        bag = rosbag.Bag(path)
    except rosbag.ROSBagUnindexedException:
        raise ValueError(f"{path}: is not complete. Run: rosbag reindex {path}") from None
    except rosbag.ROSBagException as error:
        raise ValueError(f"{path}: cannot be read as a bag: {error}") from None
    with bag:
        types = {name: info.msg_type for name, info in bag.get_type_and_topic_info().topics.items()}
        fitting = sorted(name for name, kind in types.items() if kind == TYPE)
        if not topic:
            candidates = [name for name in fitting if name.endswith("vel_cmd")]
            if len(candidates) != 1:
                found = ", ".join(candidates) or "none"
                raise ValueError(
                    f"{path}: topics of commands: {found}. Choose one with _topic:=NAME."
                )
            topic = candidates[0]
        elif topic not in fitting:
            found = ", ".join(fitting) or "none"
            raise ValueError(f"{path}: no topic {topic} of type {TYPE}. Choose one of: {found}.")
        found = [(t.to_nsec(), list(m.data)) for _, m, t in bag.read_messages(topics=[topic])]
    if not found:
        raise ValueError(f"{path}: contains no message of {topic}. Choose another topic.")
    # A bag has no message at time 0, so the first may be a nanosecond late.
    times = [(ns - (ns == 1)) / 1e9 for ns, _ in found]
    return topic, times, [speeds for _, speeds in found]
