"""Files that define the map from motor commands to rotor speeds, next to a fitted model."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Mapping, Optional

from ..._core import InputError
from ...support.input_files import read_text
from ...support.output_files import atomic_write, encode_text
from .inputs import DELAY, FULL_VOLTAGE, INPUTS, MAP


def name_input_file(model: Path) -> Path:
    """Return the path of the input file of a model."""
    return model.with_suffix(".inputs.yaml")


def write_inputs(path: Path, values: Mapping[str, float]) -> None:
    """Write the parameters of the map and a fixed delay; raise `InputError` if this fails."""
    lines = [
        f"# Rotor speed [rad/s] = speed command^exponent (voltage / {FULL_VOLTAGE:g} V)^battery,",
        "# with commands from 0 to 1.",
        *(f"{name.partition('.')[2]}: {values[name]!r}" for name in INPUTS if name in values),
    ]
    with atomic_write(path) as stream:
        stream.write(encode_text("\n".join(lines) + "\n"))


def read_inputs(path: Path) -> Dict[str, float]:
    """Read a file written by `write_inputs`.

    Raises
    ------
    InputError
        If the file is missing, or a parameter is missing, unknown or not a number.
    """
    import yaml  # slow to import

    try:
        content = yaml.safe_load(read_text(path))
    except yaml.YAMLError:
        raise InputError(f"{path}:1: this is not YAML. Correct the file.") from None
    names = [name.partition(".")[2] for name in MAP]
    delay = DELAY.partition(".")[2]
    if not isinstance(content, dict) or set(content) - {delay} != set(names):
        raise InputError(
            f"{path}: write the parameters {', '.join(names)}, {delay} if it is fixed, and no "
            "others."
        )
    for name, value in content.items():
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            raise InputError(f"{path}: {name} is '{value}'. Write a number.")
    short = {name: name.partition(".")[2] for name in INPUTS}
    return {name: float(content[key]) for name, key in short.items() if key in content}


def find_inputs(given: Optional[Path], model: str) -> Optional[Dict[str, float]]:
    """Read the given file, or else the file next to the model; return None if there is no file."""
    if given is not None:
        return read_inputs(given)
    next_to = name_input_file(Path(model))
    return read_inputs(next_to) if next_to.is_file() else None
