"""``quadcore predict``: predict real flights with a model."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..simulation.flight_plan import FlightPlan
from ..studies.flight_folder import DOCUMENT
from ..studies.option_info import OUTPUT, STUDY
from ..studies.output_folder import output_folder
from . import options, reading, terminal
from .parser import add_command, find_group

_OUT = Path("out/predict")


def register(commands: Any) -> None:
    """Add the command to the command line."""
    parser = add_command(
        commands,
        "predict",
        "Predict recordings of real flights with a model, and print the error over the horizon.",
        predict,
        """
        quadcore predict fitted.urdf --log flight.ulg --out out/predict
        """,
    )
    options.add_model(parser)
    study, output = find_group(parser, STUDY), find_group(parser, OUTPUT)
    study.add_argument(
        "--log", metavar="FILE", type=Path, required=True, action="append", default=[],
        help="recording of a flight; repeatable",
    )  # fmt: skip
    options.add_mapping(parser)
    study.add_argument(
        "--inputs",
        metavar="FILE",
        type=Path,
        help="map from commands to rotor speeds that `fit` wrote (default: MODEL.inputs.yaml "
        "next to the model, else from the hover)",
    )
    study.add_argument(
        "--controller",
        metavar="NAME",
        help="controller that follows the set-points of the recording in closed loop, to compare "
        "with the real flight: NAME[:KEY=VALUE,...] (default: none)",
    )
    add_force(parser)
    options.add_options(parser, "world")
    output.add_argument(
        "--out", metavar="DIR", type=Path, default=_OUT,
        help=f"folder for page, table and logs (default: {_OUT})",
    )  # fmt: skip
    options.add_format(parser)
    options.add_quiet(parser)


def add_force(parser: argparse.ArgumentParser) -> None:
    """Add the option to accept a model that is worse than a baseline."""
    find_group(parser, STUDY).add_argument(
        "--force",
        action="store_true",
        help="accept a model that predicts worse than a baseline at 0.25 s (default: status 3)",
    )


def predict(arguments: argparse.Namespace) -> None:
    """Predict recordings, and print and write the errors."""
    from ..studies.fit.output import FILES

    with output_folder(arguments.out, FILES, DOCUMENT):
        _predict(arguments)


def _predict(arguments: argparse.Namespace) -> None:
    from ..studies.fit.input_file import find_inputs
    from ..studies.fit.inputs import split_inputs
    from ..studies.fit.output import write_prediction
    from ..studies.fit.recorded import predict_recordings
    from .flight_tables import show_flights, show_judgement, show_replays

    shared = reading.read_model_arguments(arguments)
    _, of_model = split_inputs(shared["parameters"])
    plan = FlightPlan.of(**{**shared, "parameters": of_model}, world=arguments.world)
    judgement, flights, replays = predict_recordings(
        shared.pop("model"),
        arguments.log,
        inputs=find_inputs(arguments.inputs, arguments.model),
        mapping=arguments.mapping,
        world=arguments.world,
        controller=arguments.controller,
        **shared,
    )
    written = write_prediction(arguments.out, judgement, flights, plan.model, plan.world, replays)
    if not arguments.quiet:
        show_flights(flights)
        show_judgement(judgement)
        if replays:
            show_replays(replays)
        terminal.print_written(written)
    if not arguments.force:
        judgement.check()
