"""Commands that were recorded in a file."""

from pathlib import Path

TYPE = "std_msgs/Float64MultiArray"


def read_table(path, rotors):
    """Read commands with their times: an array of rows t (s), w1..wn (rad/s).

    Raises `ValueError`, or quadcore's `InputError`, with one line.
    """
    if not str(path).endswith(".bag"):
        from quadcore.simulation.commands import read_commands as read_file

        return read_file(path, rotors)
    from quadcore.simulation.commands import as_commands

    _, times, commands = _recorded(path, "")
    rows = dict(zip(times, commands))  # of those of one time the last counts
    if any(len(row) != rotors for row in commands):
        raise ValueError(f"{path}: holds commands that are not for {rotors} rotors; set _rotors:=N")
    return as_commands([[time, *row] for time, row in sorted(rows.items())], rotors)


def read_commands(path, topic=""):
    """Read a bag's commands in the order in which they were recorded.

    Returns the topic's name and a list of rotor speeds (rad/s) for each command. Without `topic`,
    the only topic that ends in ``vel_cmd``. Raises `ValueError` with one line if there is none.
    """
    name, _, commands = _recorded(path, topic)
    return name, commands


def _recorded(path, topic):
    """Give the topic's name, the time of each message (s), and what it holds."""
    import rosbag

    if not Path(path).is_file():
        raise ValueError(f"{path}: no such file; give a bag that holds the topic vel_cmd")
    try:
        bag = rosbag.Bag(path)
    except rosbag.ROSBagUnindexedException:
        raise ValueError(f"{path}: was cut short; run: rosbag reindex {path}") from None
    except rosbag.ROSBagException as error:
        raise ValueError(f"{path}: is no bag that can be read: {error}") from None
    with bag:
        types = {name: info.msg_type for name, info in bag.get_type_and_topic_info().topics.items()}
        fitting = sorted(name for name, kind in types.items() if kind == TYPE)
        if not topic:
            candidates = [name for name in fitting if name.endswith("vel_cmd")]
            if len(candidates) != 1:
                found = ", ".join(candidates) or "none"
                raise ValueError(f"{path}: topics of commands: {found}; name one as _topic:=NAME")
            topic = candidates[0]
        elif topic not in fitting:
            found = ", ".join(fitting) or "none"
            raise ValueError(f"{path}: no topic {topic} of {TYPE}; there are: {found}")
        found = [(t.to_nsec(), list(m.data)) for _, m, t in bag.read_messages(topics=[topic])]
    if not found:
        raise ValueError(f"{path}: holds no message of {topic}")
    # A bag has no message at time 0: the first may lie a nanosecond late.
    times = [(ns - (ns == 1)) / 1e9 for ns, _ in found]
    return topic, times, [speeds for _, speeds in found]
