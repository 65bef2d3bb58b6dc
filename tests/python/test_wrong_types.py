"""Arguments of a plainly wrong type are refused in one line of quadcore's own."""

from __future__ import annotations

import numpy as np
import pytest
from flights import quadrotor

import quadcore as qc

pytestmark = pytest.mark.usefixtures("in_empty_folder")

# What each argument refuses; its proper kinds, None among them, are left out.
TEXTS = (b"x", "nonsense")
NUMBERS = (3, 1.5, float("nan"))
LISTS = ([3], [None], (1, 2), np.eye(3))
OTHERS = ({3: 1}, {"a": None}, object(), len)
NO_NAME = (b"x", *NUMBERS, *LISTS, *OTHERS)
NO_NAMES = ("nonsense", b"x", *NUMBERS, *LISTS, {3: 1}, object(), len, None)
NO_MAPPING = (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object(), len)
NO_WHOLE = (*TEXTS, 1.5, float("nan"), *LISTS, *OTHERS, None)
NO_NUMBERS = (*TEXTS, 3, [None], *OTHERS)

OF_BOTH = {
    "model": (*NO_NAME, None),
    "engine": (*NO_NAME, None),
    "world": NO_NAME,
    "dt": (*TEXTS, *LISTS, *OTHERS),
    "parameters": NO_MAPPING,
    "xacro_args": NO_MAPPING,
    "ignore": NO_NAMES,
}
CALLS = {
    "simulation": (qc.Simulation, {**OF_BOTH, "seed": NO_WHOLE, "spawn": NO_NUMBERS}),
    "batch": (qc.BatchSimulation, {**OF_BOTH, "n": NO_WHOLE, "seed": (*TEXTS, *OTHERS)}),
    "read_model": (
        qc.read_model,
        {name: OF_BOTH[name] for name in ("model", "xacro_args", "ignore")},
    ),
    "read_world": (qc.read_world, {name: OF_BOTH[name] for name in ("world", "ignore")}),
    "run": (
        lambda **given: quadrotor("eigen").run(**{"duration": 0.01, **given}),
        {
            "duration": (*TEXTS, *LISTS, *OTHERS, None),
            "commands": (*TEXTS, *NUMBERS, *LISTS, *OTHERS),
            "log_every": NO_WHOLE,
            "progress": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "topics": NO_NAMES,
            "controller": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "reference": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
        },
    ),
    "step": (lambda **given: quadrotor("eigen").step(**given), {"n": NO_WHOLE}),
    "reset": (lambda **given: quadrotor("eigen").reset(**given), {"seed": NO_WHOLE[:-1]}),
    "log": (qc.Log, {"table": (*TEXTS, *NUMBERS, *LISTS, *OTHERS, None)}),
    "set_state": (lambda **given: quadrotor("eigen").set_state(**given), {"state": NO_NAME}),
    "restore": (
        lambda snapshot=None, allow=(): quadrotor("eigen").restore(
            quadrotor("eigen").snapshot() if snapshot is None else snapshot, allow=allow
        ),
        {"snapshot": NO_NAME, "allow": NO_NAMES},
    ),
    "topic": (lambda **given: quadrotor("eigen").topic(**given), {"name": NO_NAME}),
    "publish": (
        lambda topic, values=(1,): quadrotor("eigen").publish(topic, values),
        {"topic": NO_NAME},
    ),
    "states of a batch": (
        lambda **given: qc.BatchSimulation("quadrotor", n=2).set_state(**given),
        {"rows": (*TEXTS, *NUMBERS, *LISTS, *OTHERS, None)},
    ),
    "a log read": (qc.Log.of_file, {"path": (*NO_NAME, None)}),
    "a log written": (
        lambda **given: quadrotor("eigen").run(0.01).to_file(**given),
        {"path": (*NO_NAME, None)},
    ),
    "a log drawn": (
        lambda **given: quadrotor("eigen").run(0.01).plot(**given),
        {"directory": (*NO_NAME, None)},
    ),
    "compare": (
        lambda **given: qc.compare(**{"models": "quadrotor", "duration": 0.01, **given}),
        {
            "models": (*NUMBERS, *LISTS, *OTHERS, None),
            "vary": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, {"a": None}, object(), len),
            "duration": (*TEXTS, *LISTS, *OTHERS, None),
            "log_every": NO_WHOLE,
            "processes": (*TEXTS, 1.5, *LISTS, *OTHERS),
            "progress": (*TEXTS, *NUMBERS, *LISTS, {3: 1}, object()),
            "enigne": ("ode", 3),
            "dt": (*TEXTS, *LISTS, *OTHERS),
            "engine": (*NO_NAME, None),
            "parameters": NO_MAPPING,
            "ignore": NO_NAMES,
        },
    ),
}


@pytest.mark.parametrize(
    ("call", "argument"), [(call, name) for call, (_, names) in CALLS.items() for name in names]
)
def test_an_argument_of_a_wrong_type_is_refused_in_one_line(call, argument):
    function, arguments = CALLS[call]
    for value in arguments[argument]:
        with pytest.raises(qc.InputError) as refusal:
            function(**{argument: value})
        told = str(refusal.value)
        assert "\n" not in told and len(told) < 250, value
        assert "supported" not in told and "has no attribute" not in told, value


def test_lists_that_come_one_by_one_are_read_once():
    assert len(qc.compare((name for name in ["quadrotor", "iris"]), duration=0.01).table) == 2
    with pytest.raises(qc.InputError, match="nonsense"):
        qc.Simulation("quadrotor", ignore=(name for name in ["nonsense"]))
    log = quadrotor("eigen").run(0.01, topics=(name for name in ["odom"]))
    assert list(log.topics) == ["odom"]
    with pytest.raises(qc.InputError, match=r"vary is .*give a mapping of names to lists"):
        qc.compare("quadrotor", {"motorpid_plugin.kp": (kp for kp in [1e-3])})
    with pytest.raises(qc.InputError, match=r"models is \[\]; give a name, or several"):
        qc.compare([])


def test_numbers_and_names_that_cannot_be_meant_are_told():
    with pytest.raises(qc.InputError, match=r"^steps: give a whole number below 2\^63$"):
        quadrotor("eigen").step(2**63)
    with pytest.raises(qc.InputError, match=r"^topic: give a name in UTF-8$"):
        quadrotor("eigen").topic("\udc80")


def test_what_reading_a_state_raises_is_seen():
    class Late:
        @property
        def time(self):
            raise RuntimeError("not yet")

    with pytest.raises(RuntimeError, match="not yet"):
        quadrotor("eigen").set_state(Late())


def test_a_long_value_is_shortened_in_what_is_said_of_it():
    with pytest.raises(qc.InputError) as refusal:
        qc.Simulation("quadrotor", parameters=np.arange(10000.0).reshape(-1, 10))
    told = str(refusal.value)
    assert told.startswith("parameters is array([[") and len(told) < 250 and "\n" not in told
    assert told.endswith("give a mapping of names to values")


def test_an_option_that_there_is_not_is_told_with_the_nearest():
    with pytest.raises(qc.InputError, match="no option 'enigne' \\(did you mean 'engine'\\)"):
        qc.compare("quadrotor", enigne="ode")
