#!/usr/bin/env python3
"""Print a model as plain URDF: ``expand_model.py MODEL [ARG=VALUE ...]``.

MODEL is a URDF or xacro file, or the name of a shipped model. ARG:=VALUE means the same, but in an
argument of roslaunch it makes ROS print errors about a bad remapping. For launch files, which load
the output as robot_description. With quadcore installed for Python its errors name file and line;
without, the xacro of the ROS distribution does the work.
"""

import re
import sys
from pathlib import Path


def shipped(model):
    """Path of a model: itself, or that of the shipped model of this name."""
    if Path(model).is_file():
        return model
    import rospkg

    folder = Path(rospkg.RosPack().get_path("quadcore")) / "urdf"
    for name in (model, model + ".urdf.xacro", model + ".urdf"):
        if (folder / name).is_file():
            return str(folder / name)
    sys.exit(f"error: {model}: no such file, and no shipped model of that name in {folder}")


def expand(path, arguments):
    """Text of the URDF."""
    try:
        from quadcore import QuadcoreError
        from quadcore.model.description import load_description
    except ImportError:
        pass
    else:
        try:
            return load_description(path, arguments).text
        except QuadcoreError as error:
            sys.exit(f"error: {error}")
    if not path.endswith(".xacro"):
        return Path(path).read_text(encoding="utf-8")
    try:
        import xacro
    except ImportError:
        sys.exit(
            f"error: {path}: needs xacro to be expanded; install ros-noetic-xacro, "
            "or where the distribution has none: pip install xacro"
        )
    return xacro.process_file(path, mappings=arguments).toprettyxml(indent="  ")


if len(sys.argv) < 2 or any("=" not in argument for argument in sys.argv[2:]):
    sys.exit(__doc__)
arguments = dict(re.split(":?=", word, maxsplit=1) for word in sys.argv[2:])
print(expand(shipped(sys.argv[1]), arguments))
