"""Parameters of your own controllers, read in a separate process."""

from __future__ import annotations

import math
from dataclasses import replace

from ..._core import InputError, QuadcoreError, parse_number
from ...control import controllers
from ...control.gains import Gains
from ...control.plugin_controller import NAME
from ...simulation.flight_plan import FlightPlan
from ...support.warning import suppress_warnings
from ..executor import call_apart
from ..time_limit import time_limit


def read_own(text: str, plan: FlightPlan, limit: float) -> Gains:
    """Read the timing and the parameters of a user-defined controller.

    Parameters
    ----------
    text
        Controller, as for `controllers.parse`.
    plan
        Plan of a flight; a plugin controller is added to its vehicle.
    limit
        Wall-clock limit, s.

    Raises
    ------
    InputError
        If the controller cannot be made.
    """

    def import_it() -> Gains:
        with suppress_warnings(), time_limit(limit):
            if controllers.uses_plugin(text):
                return _read_tags(text, plan)
            return controllers.read_own(text)

    try:
        return call_apart(import_it)
    except QuadcoreError as error:
        raise InputError(str(error)) from error


def _read_tags(text: str, plan: FlightPlan) -> Gains:
    """Return the numeric tags of a plugin with their given or default values."""
    made = controllers.parse(text)
    simulation = replace(plan, controller=made, on_reference=False).simulation()
    (plugin,) = (each for each in simulation.plugins if each.name == NAME)
    numbers = {tag.name: parse_number(tag.value) for tag in plugin.parameters}
    return Gains(
        controllers.split_own(text)[0],
        rate=math.nan,
        delay=math.nan,
        parameters={name: number for name, number in numbers.items() if number is not None},
    )
