"""Model of a fit, expanded again for each value of a free xacro argument."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Sequence, Union

from ..._core import InputError, Model, World
from ...model.description import list_xacro_arguments, read_both
from ...model.overrides import XACRO, apply_link_values, check_names, split_xacro_arguments
from ...simulation.engines import EngineName
from ...simulation.simulation import Simulation
from ...support.values import format_value
from .model_text import write_values

_PREFIX = f"{XACRO}."


class FittedModel:
    """Model with fixed values and free parameters.

    Parameters
    ----------
    free
        Names of the free parameters.
    model, engine, world, dt, parameters, xacro_args, ignore
        As for `fit`.

    Attributes
    ----------
    model : Model
        Model with the start values.
    simulation : Simulation
        Simulation of `model`.
    arguments : dict of str to str
        Start value of each ``xacro.ARG``; empty unless a xacro argument is free.
    make : dict
        Keyword arguments of `BatchSimulation` except n, dt and parameters.
    fixed : dict of str to str
        Parameters that are set but not free.

    Raises
    ------
    InputError
        If an argument is invalid, or a xacro argument is free but `model` is not a file.
    """

    def __init__(
        self,
        free: Sequence[str],
        model: Union[str, Path, Model],
        engine: EngineName,
        world: Union[str, Path, World, None],
        dt: Optional[float],
        parameters: Optional[Mapping[str, Any]],
        xacro_args: Optional[Mapping[str, object]],
        ignore: Sequence[str],
    ) -> None:
        of_xacro, others = split_xacro_arguments(parameters, xacro_args)
        read, world = read_both(model, world, of_xacro, ignore)
        check_names(read, [*(parameters or {}), *free])
        given = {name: format_value(value) for name, value in others.items()}
        self.model, tags = apply_link_values(read, given)
        self.simulation = Simulation(self.model, engine=engine, world=world, dt=dt, parameters=tags)
        self.arguments: Dict[str, str] = {}
        begin: Union[str, Path, Model] = self.model
        found = [name for name in free if name.startswith(_PREFIX)]
        if found:
            if isinstance(model, Model):
                raise InputError(f"free {found[0]}: a Model has no xacro arguments. Give the file.")
            known = list_xacro_arguments(model, of_xacro)
            self.arguments = {_PREFIX + name: text for name, text in known.items()}
            of_xacro = {n: value for n, value in of_xacro.items() if _PREFIX + n not in free}
            begin, tags = model, given
        else:
            of_xacro = {}
        self.fixed = {name: value for name, value in tags.items() if name not in free}
        self.make: Dict[str, Any] = {
            "model": begin,
            "engine": engine,
            "world": world,
            "xacro_args": of_xacro,
            "ignore": ignore,
        }

    def make_model(self, values: Mapping[str, float]) -> Model:
        """Read the model with the fixed values and these values of the free parameters."""
        make = self.make
        of_xacro, others = split_xacro_arguments(values, make["xacro_args"])
        read, _ = read_both(make["model"], make["world"], of_xacro, make["ignore"])
        aliases = {
            f"{plugin.name}.{tag.name}": f"{plugin.name}.{tag.alias}"
            for plugin in self.simulation.plugins
            for tag in plugin.parameters
            if tag.alias
        }
        names = {alias: name for name, alias in aliases.items()}
        fixed = {names.get(name, name): value for name, value in self.fixed.items()}
        return write_values(read, {**fixed, **others}, aliases)
