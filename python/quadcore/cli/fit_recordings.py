"""``quadcore fit`` with recordings of real flights."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Dict, Optional, Sequence, Tuple

from .._core import InputError
from ..model.description import read_world
from ..simulation.engines import STUDY_ENGINE
from ..support.output_files import atomic_write, encode_text
from . import reading, terminal

DAMAGE = "rotors.factor"
"""Name of the free parameter for the thrust factors of the rotors."""

_FACTORS = "rotorFactors"
_OF_LOGS = ("commands", "sensed", "channels", "shift", "horizon", "engine", "dt")
"""Options that apply only to a fit of a single log of quadcore."""


def fit_real_flights(
    arguments: argparse.Namespace,
    out: Path,
    folder: Optional[Path],
    bounds: Dict[str, Tuple[float, float]],
) -> None:
    """Fit a model to recordings, judge it, and write it with its input map.

    Parameters
    ----------
    arguments
        Arguments of the command.
    out
        File of the fitted model.
    folder
        Folder for the page; None: no page.
    bounds
        Minimum and maximum value by parameter name.
    """
    from ..studies.fit.input_file import name_input_file, write_inputs
    from ..studies.fit.output import write_recorded_fit
    from ..studies.fit.recorded import fit_recordings
    from .flight_tables import show_fit, show_flights, show_judgement

    refuse_options(arguments, (*_OF_LOGS, "sound"), "a fit of several logs or recordings")
    if not arguments.judge:
        refuse_options(arguments, ("force",), "a fit without --judge")
    shared = reading.read_model_arguments(arguments)
    with terminal.show_progress(arguments.quiet, "fitting") as progress:
        fit = fit_recordings(
            shared.pop("model"),
            arguments.log,
            arguments.judge,
            free=arguments.free,
            mapping=arguments.mapping,
            bounds=bounds,
            world=arguments.world,
            progress=progress,
            **shared,
        )
    with atomic_write(out) as stream:
        stream.write(encode_text(fit.model.document.text))
    written = [out, name_input_file(out)]
    write_inputs(written[1], fit.found.values)
    if folder is not None:
        world = read_world(arguments.world, arguments.ignore)
        written += write_recorded_fit(folder, fit, world)
    if not arguments.quiet:
        show_flights([*fit.flights, *fit.judged])
        show_fit(fit)
        if fit.judgement:
            show_judgement(fit.judgement)
        terminal.print_written(written)
    if fit.judgement and not arguments.force:
        fit.judgement.check()


def fit_damage(arguments: argparse.Namespace, out: Path, folder: Optional[Path]) -> None:
    """Find the factors of damaged rotors, print them, and write the model and a page."""
    from ..studies.fit.fitted_model import FittedModel
    from ..studies.fit.model_text import write_values
    from ..studies.fit.output import write_rotor_factors
    from ..studies.fit.predictor import find_plugin
    from ..studies.fit.prepared import read_flight
    from ..studies.fit.rotor_factors import find_rotor_factors

    refuse_options(arguments, (*_OF_LOGS, "judge", "bound", "force"), f"--free {DAMAGE}")
    if not arguments.sound:
        raise InputError(
            f"free {DAMAGE}: name recordings of the undamaged vehicle with --sound FILE."
        )
    shared = reading.read_model_arguments(arguments)
    fitted = FittedModel(
        [],
        shared["model"],
        STUDY_ENGINE,
        arguments.world,
        None,
        shared["parameters"],
        shared["xacro_args"],
        shared["ignore"],
    )
    plugin = find_plugin(fitted, _FACTORS)
    if plugin is None:
        raise InputError(f"free {DAMAGE}: the model has no plugin with the tag {_FACTORS}.")
    found = find_rotor_factors(
        [read_flight(log, arguments.mapping) for log in arguments.log],
        [read_flight(log, arguments.mapping) for log in arguments.sound],
    )
    rotors = fitted.simulation.rotors
    if len(rotors) != len(found.factors):
        raise InputError(
            f"the recordings have {len(found.factors)} rotors, the model {len(rotors)}."
        )
    text = " ".join(f"{factor:.6g}" for factor in found.factors)
    model = write_values(fitted.model, {**fitted.fixed, f"{plugin}.{_FACTORS}": text})
    with atomic_write(out) as stream:
        stream.write(encode_text(model.document.text))
    written = [out]
    verdict = "no rotor has lost thrust for certain"
    worst = found.damaged
    if worst is not None:
        loss = 100 * (1 - found.factors[worst])
        verdict = f"rotor {worst + 1} ({rotors[worst].joint}) has lost {loss:.0f} % of its thrust"
    cells = [
        (str(i + 1), rotors[i].joint, f"{factor:.3f}", f"{deviation:.2g}")
        for i, (factor, deviation) in enumerate(zip(found.factors, found.deviations))
    ]
    if folder is not None:
        rows = [
            {
                "name": f"thrust of rotor {number} ({joint})",
                "start": "1",
                "value": factor,
                "deviation": deviation,
                "unit": "1",
            }
            for number, joint, factor, deviation in cells
        ]
        world = read_world(arguments.world, arguments.ignore)
        headline = f"{verdict[:1].upper()}{verdict[1:]}."
        written += write_rotor_factors(folder, headline, rows, model, world)
    if arguments.quiet:
        return
    console = terminal.make_console()
    table = terminal.make_table("rotor", "joint", "factor", "std dev", numbers=True)
    for row in cells:
        table.add_row(*row)
    console.print(table, "")
    console.print(verdict)
    terminal.print_written(written)


def refuse_options(arguments: argparse.Namespace, names: Sequence[str], what: str) -> None:
    """Raise `InputError` for options that have no effect on a fit."""
    for name in names:
        value = getattr(arguments, name)
        if value not in (None, [], False) and (name, value) != ("engine", STUDY_ENGINE):
            raise InputError(f"--{name} does not apply to {what}. Remove it.")
