"""The public class `Fleet`."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from .. import _core
from .._core import InputError
from ..control.controller import ControllerLike
from ..control.keywords import ReferenceName
from ..control.references import ReferenceLike
from ..model.description import check_names_argument
from ..support.arguments import PROGRESS, check, or_none, shorten
from ..support.warning import warn
from .commands import CommandsLike, check_commands
from .controller_pilot import make_pilot
from .engines import check_wrenches
from .fleet_flight import FlightOfVehicle, fly_fleet
from .flight import Progress, check_log_every, count_steps, list_columns
from .log import Log
from .rows import Rows
from .simulation import Simulation, check_source, check_start, find_start

CommandsOfFleet = Union[CommandsLike, Mapping[str, Optional[CommandsLike]], None]
"""Commands of all vehicles, or a mapping of vehicle names to commands."""

ControllerOfFleet = Union[ControllerLike, Mapping[str, Optional[ControllerLike]], None]
"""Name of a controller for all vehicles, or a mapping of vehicle names to controllers."""

ReferenceOfFleet = Union[
    ReferenceLike,
    ReferenceName,
    Mapping[str, Union[ReferenceLike, ReferenceName, None]],
    None,
]
"""Reference of all vehicles, or a mapping of vehicle names to references."""


class Fleet(_core.Fleet):
    """Simulate several vehicles in one world.

    Each vehicle is a `Simulation` with its own model, parameters, seed and spawn. A vehicle that
    touches no other vehicle, and has no plugin that observes others, moves bit-identically to a
    separate simulation. In the engines gazebo11 and ode, vehicles collide with each other and with
    the free bodies of the world, as in Gazebo. In the engine eigen, vehicles pass through each
    other, and a warning says so.

    Parameters
    ----------
    vehicles : sequence of Simulation, or mapping of str to Simulation
        Vehicles with the same engine, world and step. A mapping defines their names. Otherwise they
        have the names of their models, with a number if several are equal. The fleet resets all
        vehicles to their initial states. Afterwards only the fleet can advance them.

    Attributes
    ----------
    vehicles : dict of str to Simulation
        Vehicles by name, in the order in which they were added to the world.

    Raises
    ------
    InputError
        If engine, world or step differ, or a simulation already belongs to a fleet.

    Warns
    -----
    QuadcoreWarning
        If the engine does not simulate contact between vehicles.
    """

    def __init__(self, vehicles: Union[Sequence[Simulation], Mapping[str, Simulation]]) -> None:
        if not isinstance(vehicles, Mapping):
            names = [v.model.name if isinstance(v, Simulation) else "" for v in vehicles]
            vehicles = name_vehicles(names, vehicles)
        for name, vehicle in vehicles.items():
            if not (isinstance(name, str) and isinstance(vehicle, Simulation)):
                raise InputError(
                    f"vehicle {shorten(name)} is {shorten(vehicle)}. Give a quadcore.Simulation."
                )
        super().__init__(list(vehicles.values()), list(vehicles))
        self.vehicles: Dict[str, Simulation] = dict(vehicles)
        for warning in self.warnings:
            warn(warning)

    def run(
        self,
        duration: float,
        commands: CommandsOfFleet = None,
        log_every: int = 1,
        progress: Optional[Progress] = None,
        wrenches: bool = False,
        topics: Sequence[str] = (),
        *,
        controller: ControllerOfFleet = None,
        reference: ReferenceOfFleet = None,
        on_reference: bool = False,
    ) -> Dict[str, Log]:
        """Simulate all vehicles for a duration, and log the states of each vehicle.

        Any exception that ends the run has the attribute `logs`, which contains the rows so far.

        Parameters
        ----------
        duration, log_every, progress, wrenches, topics
            As for `Simulation.run`.
        commands, controller, reference
            As for `Simulation.run`, for all vehicles; or a mapping of vehicle names to these, in
            which vehicles may be missing.
        on_reference
            As for `Simulation.run`. Vehicles without a reference start in their current states.

        Returns
        -------
        dict of str to Log
            Log of each vehicle by name.

        Raises
        ------
        InputError
            If an argument is invalid; in this case nothing is simulated. Also if a callback moves a
            vehicle.
        FlightError
            If a flight fails, or a controller returns an invalid command.
        """
        count_steps(duration, self.dt)
        check_log_every(log_every)
        names = check_names_argument("topics", topics)
        check({"progress": progress}, {"progress": or_none(PROGRESS)})
        tables = _spread("commands", commands, self.names)
        controllers = _spread("controller", controller, self.names)
        references = _spread("reference", reference, self.names)
        check_start(on_reference, *references.values())
        if not isinstance(controller, (str, Mapping, type(None))) and len(self.names) > 1:
            raise InputError(
                "controller is one object for several vehicles. Give a mapping of names to the "
                "controller of each."
            )
        flights: List[FlightOfVehicle] = []
        rows: Dict[str, Rows] = {}
        for name, vehicle in self.vehicles.items():
            if wrenches:
                check_wrenches(vehicle.engine)
            law, path = controllers[name], references[name]
            check_source(tables[name], law, path)
            pilot = None if law is None else make_pilot(law, vehicle, path)
            if pilot is not None and pilot.moves:
                raise InputError(f"vehicle '{name}': its controller moves the vehicle itself.")
            rows[name] = Rows(vehicle, list_columns(vehicle, names, pilot))
            receive, table = rows[name].receive, tables[name]
            if table is not None:
                table = check_commands(table, vehicle.command_width)
            flights.append(FlightOfVehicle(name, vehicle, receive, table, pilot, wrenches, names))
        if on_reference:  # after all checks, as it moves the vehicles
            self._start_on(references, controllers)
        try:
            fly_fleet(self, duration, flights, log_every, progress)
        except (Exception, KeyboardInterrupt) as error:
            error.logs = _collect(rows)  # type: ignore[union-attr]
            raise
        return _collect(rows)

    def _start_on(self, references: Mapping[str, Any], controllers: Mapping[str, Any]) -> None:
        """Move each vehicle with a reference onto it."""
        starts = {
            name: find_start(vehicle, controllers[name], references[name])
            for name, vehicle in self.vehicles.items()
            if references[name] is not None
        }
        for name, start in starts.items():
            self.vehicles[name].set_state(start)

    def __repr__(self) -> str:
        return f"<Fleet of {', '.join(self.names)}, t = {self.time:g} s, steps of {self.dt:g} s>"


def _collect(rows: Mapping[str, Rows]) -> Dict[str, Log]:
    return {name: each.log() for name, each in rows.items()}


def name_vehicles(names: Sequence[str], vehicles: Sequence[Simulation]) -> Dict[str, Simulation]:
    """Return the vehicles by name; repeated names get a number."""
    named: Dict[str, Simulation] = {}
    for wanted, vehicle in zip(names, vehicles):
        name, number = wanted, 1
        while name in named:
            number += 1
            name = f"{wanted}_{number}"
        named[name] = vehicle
    return named


def _spread(what: str, value: Any, names: Sequence[str]) -> Dict[str, Any]:
    """Return the value for each vehicle by name."""
    if not isinstance(value, Mapping):
        return dict.fromkeys(names, value)
    for name in value:
        if name not in names:
            raise InputError(
                f"{what}: no vehicle has the name {shorten(name)}. Use {', '.join(names)}."
            )
    return {name: value.get(name) for name in names}
