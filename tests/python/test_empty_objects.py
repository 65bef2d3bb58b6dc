"""Objects of bound classes that no constructor has run for, and every protocol of pickle."""

from __future__ import annotations

import copy
import pickle

import pytest

import quadcore as qc
from quadcore import _core

BOUND = [
    kind
    for kind in [*vars(_core).values(), qc.Simulation, qc.BatchSimulation]
    if isinstance(kind, type) and not issubclass(kind, Exception)
]


def test_there_are_bound_classes_to_try():
    assert {"Batch", "Flight", "Run", "ReferenceShape", "Controller", "IgnoredElements"} < {
        kind.__name__ for kind in BOUND
    }


@pytest.mark.parametrize("kind", BOUND)
def test_an_object_that_no_constructor_has_run_for_raises_whatever_is_asked(kind):
    refused = 0
    for name in vars(kind):
        if name in ("__init__", "__new__", "__setstate__"):
            continue
        for arguments in range(5):
            try:
                held = getattr(kind.__new__(kind), name)
                if callable(held):
                    held(*[None] * arguments)
            except qc.InputError as error:
                refused += "the object is empty" in str(error)
            except (TypeError, AttributeError):
                pass  # another number of arguments, or what __init__ would have set
    assert refused or kind is _core.BatchSnapshot  # which has nothing to ask for


def test_a_half_built_object_can_be_shown_by_a_debugger():
    class Early(qc.BatchSimulation):
        def __init__(self):
            self.dt  # noqa: B018
            super().__init__()

    with pytest.raises(qc.InputError, match=r"call super\(\).__init__\(\) first"):
        Early()
    with pytest.raises(qc.InputError, match="the object is empty"):
        repr(qc.BatchSimulation.__new__(qc.BatchSimulation))


def test_a_second_constructor_leaves_the_object_as_it_is():
    simulation = qc.Simulation("quadrotor", engine="eigen")
    simulation.step(10)
    simulation.__init__("firefly")
    assert len(simulation.state.rotor_velocity) == 4 and simulation.time == pytest.approx(0.01)
    model = simulation.model
    model.__setstate__(qc.read_model("iris").__getstate__())
    assert model.name == "quadrotor"


def built():
    """Make an object of every class that can be made from here."""
    simulation = qc.Simulation("quadrotor", engine="eigen")
    model = qc.read_model("quadrotor")
    controller = _core.Controller("geometric", simulation, simulation, {}, [])
    some = [simulation, qc.BatchSimulation(n=2), qc.BatchSimulation(n=2).snapshot(), controller]
    some += [model.document, model.ignored_elements, model.links[0], model.joints[0]]
    some += [simulation.plugins[0], simulation.plugins[0].parameters[0], simulation.topics["odom"]]
    some += [_core.Run(simulation), _core.Flight(simulation, None, 1), _core.Reference()]
    some += [_core.ReferenceShape("hover", {}), _core.InnerLoop(simulation, simulation, {}, [])]
    return some


@pytest.mark.parametrize("thing", built(), ids=lambda thing: type(thing).__name__)
def test_what_cannot_be_pickled_says_so_in_every_protocol(thing):
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        with pytest.raises(TypeError, match="cannot pickle"):
            pickle.dumps(thing, protocol)
        with pytest.raises(TypeError, match="cannot pickle"):
            thing.__reduce_ex__(protocol)
    for reduce in (copy.copy, copy.deepcopy, type(thing).__reduce__):
        with pytest.raises(TypeError, match="cannot pickle"):
            reduce(thing)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_snapshots_models_and_worlds_are_pickled_in_every_protocol(protocol):
    simulation = qc.Simulation("quadrotor", engine="eigen")
    simulation.step(5)
    for thing in (simulation.snapshot(), qc.read_model("quadrotor"), simulation.world):
        other = pickle.loads(pickle.dumps(thing, protocol))
        assert pickle.dumps(other, 4) == pickle.dumps(thing, 4)
        assert pickle.dumps(copy.deepcopy(thing), 4) == pickle.dumps(thing, 4)
