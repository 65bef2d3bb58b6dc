"""Autopilots that are separate programs and answer over a network."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence

from .._core import InputError
from .autopilot import Autopilot
from .program import Program
from .sticks import StickPilot, Sticks


class ProgramAutopilot(Autopilot):
    """Controller that starts a program for each flight, and ends it with the flight.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    parameters : mapping of str to str
        Parameters of the autopilot by name.
    hold : float
        Duration of the phase before the flight, s.
    where : mapping of str to str, optional
        As for `Autopilot`.
    **others
        Other parameters of `Autopilot`.
    """

    def __init__(
        self,
        command: Sequence[str],
        parameters: Mapping[str, str],
        hold: float,
        where: Optional[Mapping[str, str]],
        **others: Any,
    ) -> None:
        super().__init__(hold=hold, where=where, **others)
        self._command = list(command)
        self._parameters = dict(parameters)
        self._settings: Dict[str, Any] = {"hold": hold, **others}
        self._program: Optional[Program] = None
        self._exchange: Any = None  # connection with `Link`, summarize() and close()

    def close(self) -> None:
        """End the program, and remove its folder."""
        super().close()
        if self._exchange is not None:
            self.summary = f"{self._exchange.summarize()}, {self.describe_speed()}"
            self._exchange.close()
            self._exchange = None
        if self._program is not None:
            self._program.stop()
            self._program = None

    def _check_hold(self, name: str, shortest: float) -> None:
        if self.hold < shortest:
            raise InputError(
                f"{self._where.get('hold', '')}hold is {self.hold:g}, but {name} needs at least "
                f"{shortest:g} s before the flight. Give more."
            )

    def _fill_in(self, values: Mapping[str, object]) -> List[str]:
        command = self._command
        for name, value in values.items():
            command = [part.replace(f"{{{name}}}", str(value)) for part in command]
        return command

    def _quote_messages(self) -> str:
        return "" if self._program is None else self._program.describe_messages()


def fly_reference(pilot: StickPilot, state: Any, reference: Any) -> Sticks:
    """Return the sticks with which a pilot follows a reference.

    Raises
    ------
    InputError
        If there is no reference.
    """
    if reference is None:
        raise InputError("The pilot of an autopilot needs a reference. Add --reference hover.")
    return pilot.fly(state, reference)
