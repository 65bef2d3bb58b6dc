"""The options of what is flown in all combinations, which `evaluate` and `sweep` share."""

from __future__ import annotations

import argparse

from ..control import laws, references
from ..model import resources
from ..simulation.scenarios import NONE
from ..support import option_values
from . import options


def add(parser: argparse.ArgumentParser) -> None:
    """Add what is flown in all combinations: controllers, references, models, seeds, scenarios."""
    parser.add_argument(
        "file", metavar="FILE.yaml", nargs="?", help="options by name; those given besides win"
    )
    parser.add_argument(
        "--controller",
        metavar="A,B",
        type=option_values.several_calls,
        help=f"{', '.join(laws.NAMES)}, perhaps with parameters, LAW:KEY=VALUE,...; files of "
        "gains; MODULE:CLASS",
    )
    parser.add_argument(
        "--reference",
        metavar="A,B",
        type=option_values.several_calls,
        help=f"{', '.join(references.NAMES)}, NAME:KEY=VALUE,..., or files",
    )
    parser.add_argument(
        "--model",
        metavar="A,B",
        type=option_values.names,
        default=["quadrotor"],
        help="what flies, files or shipped (quadrotor)",
    )
    options.add_changes(parser)
    parser.add_argument(
        "--seeds", metavar="N", type=option_values.integer(1), default=1, help="from --seed on (1)"
    )
    parser.add_argument(
        "--scenario",
        metavar="A,B",
        type=option_values.names,
        help="what befalls the vehicle, files or shipped: "
        + f"{', '.join([NONE, *resources.shipped('config/scenarios')])} ({NONE})",
    )
