#!/usr/bin/env python3
"""Print a model as plain URDF: ``expand_model.py MODEL [ARG=VALUE ...]``.

MODEL is a URDF or xacro file, or the name of a built-in model. ARG:=VALUE means the same, but as an
argument of roslaunch it makes ROS print errors about a bad remapping. Launch files load the output
as robot_description. If quadcore is installed for Python, errors name file and line. Otherwise, the
script uses the xacro of the ROS distribution.
"""

import re
import sys
from pathlib import Path


def find_model(model):
    """Return the path of a model: a file, or the built-in model of this name."""
    if Path(model).is_file():
        return model
    import rospkg

    folder = Path(rospkg.RosPack().get_path("quadcore")) / "urdf"
    for name in (model, model + ".urdf.xacro", model + ".urdf"):
        if (folder / name).is_file():
            return str(folder / name)
    sys.exit(f"error: {model}: does not exist. Name a file, or a built-in model in {folder}.")


def expand(path, arguments):
    """Return the text of the URDF."""
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
            f"error: {path}: needs xacro. Install ros-noetic-xacro, or run pip install xacro if "
            "the distribution does not have it."
        )
    return xacro.process_file(path, mappings=arguments).toprettyxml(indent="  ")


if len(sys.argv) < 2 or any("=" not in argument for argument in sys.argv[2:]):
    sys.exit(__doc__)
arguments = dict(re.split(":?=", word, maxsplit=1) for word in sys.argv[2:])
print(expand(find_model(sys.argv[1]), arguments))
