"""Shell command that repeats a row."""

from __future__ import annotations

import shlex
from typing import Any, Dict, List, Mapping, Optional

from ...control import controllers
from ...control.built_in import BuiltInController
from ..axes import OF_CONTROLLER
from ..control_setup import names_user_code
from ..variation import pick_controller_values
from .plan import AnyPlan, Plan


def write_command(plan: AnyPlan, row: int) -> Optional[str]:
    """Return the command that repeats a row; None for controller objects and functions."""
    if not isinstance(plan, Plan):
        return None
    case = plan[row]
    description, point = plan.describe(), plan.design[case.point]
    flags: Dict[str, Any] = {"engine": plan.engines[case.engine], "world": description["world"]}
    if plan.control.is_closed_loop:
        flown = plan.control.things[case.controller]
        if not isinstance(flown, str):
            return None
        flags["controller"] = _write_controller(plan, row, flown, point)
        flags["reference"] = plan.control.references[case.reference]
        flags["controller-rate"], flags["delay"] = (
            description["controller_rate"],
            description["delay"],
        )
        for name in ("rate", "delay"):
            given = point.get(f"{OF_CONTROLLER}{name}")
            if given is not None:
                flags["controller-rate" if name == "rate" else name] = given
    else:
        flags["commands"] = description["commands"]
    for name in ("world", "scenario"):
        flags[name] = point.get(name, flags.get(name))
    flags.update(seed=plan.seeds[case.seed], duration=description["duration"], dt=plan.options.dt)
    if description["spawn"] is not None:
        flags["spawn"] = ",".join(map(repr, description["spawn"]))
    if description["wind"] is not None:
        flags["wind"] = ",".join(map(repr, description["wind"]))
    words = ["quadcore", "run", plan.models[case.model]]
    words += [f"--{name}={_format(value)}" for name, value in flags.items() if value is not None]
    words += [f"--xacro={name}:={value}" for name, value in description["xacro"].items()]
    words += [
        f"--set={name}={value}"
        for name, value in _collect_parameters(description["set"], point).items()
    ]
    words += [f"--ignore={name}" for name in description["ignore"]]
    words.append(f"--log-every={description['log_every']}")
    return " ".join(map(shlex.quote, words))


def _collect_parameters(common: Mapping[str, str], point: Mapping[str, str]) -> Dict[str, str]:
    values = dict(common)
    for names, value in point.items():
        if names not in ("world", "scenario") and not names.startswith(OF_CONTROLLER):
            values.update(dict.fromkeys(names.split(","), value))
    return values


def _write_controller(plan: Plan, row: int, text: str, point: Mapping[str, str]) -> str:
    """Return the name of the controller with the parameter values of the point."""
    keys = [name[len(OF_CONTROLLER) :] for name in point if name.startswith(OF_CONTROLLER)]
    if not set(keys) - {"rate", "delay"}:
        return text
    if names_user_code(text):
        name, given = controllers.split_own(text)
        parameters = {**given, **pick_controller_values(point)}
    else:
        controller: BuiltInController = plan.make_spec(row).plan.controller
        name, parameters = controller.name, controller.parameters
    values: List[str] = [f"{key}={value!r}" for key, value in parameters.items()]
    return f"{name}:{','.join(values)}"


def _format(value: Any) -> str:
    return f"{value:.17g}" if isinstance(value, float) else str(value)
