"""Everything public says what it is."""

from __future__ import annotations

import doctest
import inspect
import re
from typing import get_args

import pytest

import quadcore as qc
from quadcore import _core
from quadcore.thesis import chapter2

PUBLIC = {
    f"{module.__name__}.{name}": getattr(module, name)
    for module in (qc, qc.controllers, qc.references, _core)
    for name in getattr(module, "__all__", dir(module))
    if not name.startswith("_")
}
THINGS = {n: value for n, value in PUBLIC.items() if callable(value) and not get_args(value)}


def read_text(member, name):
    """What a docstring says beside the signatures that pybind11 writes."""
    text = inspect.getdoc(member) or ""
    return re.sub(rf"^(\d+\. )?{name}\(.*\)( -> .*)?$", "", text, flags=re.MULTILINE).strip()


def members(thing):
    """Public members of a class and of those that it stems from, by name."""
    for kind in reversed(thing.__mro__):
        if kind.__module__.startswith("quadcore"):
            for name in vars(kind):
                if not name.startswith("_"):
                    member = inspect.getattr_static(thing, name)
                    yield name, member if isinstance(member, property) else getattr(thing, name)


@pytest.mark.parametrize("name", THINGS)
def test_each_class_and_function_has_a_docstring(name):
    assert read_text(THINGS[name], name.rpartition(".")[2])


def has_text(kind, name, member):
    """Whether a member has a docstring, or a line among the attributes of its class."""
    if (callable(member) or isinstance(member, property)) and read_text(member, name):
        return True
    classes = [inspect.getdoc(each) or "" for each in kind.__mro__]
    return any(re.search(rf"^(\w+, )*{name}(, \w+)*( :|$)", text, re.MULTILINE) for text in classes)


@pytest.mark.parametrize("name", [name for name, thing in THINGS.items() if inspect.isclass(thing)])
def test_each_member_is_documented(name):
    undocumented = [
        member
        for member, value in members(THINGS[name])
        if not has_text(THINGS[name], member, value)
    ]
    # The pages that use the core's own class describe it.
    assert undocumented == (["command_topic"] if name == "quadcore._core.Simulation" else [])


def functions(name):
    """What can be called of a public thing, by name: the thing itself and its methods."""
    thing = THINGS[name]
    yield name, thing
    if inspect.isclass(thing):
        yield from ((f"{name}.{m}", f) for m, f in members(thing) if inspect.isroutine(f))


def arguments(function):
    """Names of the arguments of a function, also of one that is bound."""
    bound = re.match(r"\w+\((.*)\) -> ", inspect.getdoc(function) or "")
    if bound:
        return [name for name in re.findall(r"(\w+): ", bound.group(1)) if name != "self"]
    try:
        named = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # a class that nobody makes
        return []
    several = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    return [each.name for each in named if each.kind not in several and each.name != "self"]


@pytest.mark.parametrize("name", [name for name in THINGS if "._" not in name])
def test_each_argument_is_documented(name):
    undocumented = []
    for called, function in functions(name):
        kinds = getattr(function, "__mro__", [function])
        docstrings = "\n".join(inspect.getdoc(kind) or "" for kind in kinds)
        undocumented += [
            f"{called}({argument})"
            for argument in arguments(function)
            if not re.search(rf"^(\w+, )*{argument}(, \w+)*( :|$)", docstrings, re.MULTILINE)
        ]
    assert undocumented == []


@pytest.mark.parametrize("module", [qc, chapter2], ids=lambda module: module.__name__)
def test_the_example_that_help_begins_with_does_what_it_says(module):
    [example] = doctest.DocTestFinder(recurse=False).find(module)
    said = []
    ran = doctest.DocTestRunner().run(example, out=said.append)
    assert ran.attempted > 2 and not ran.failed, "".join(said)


def test_a_public_object_does_not_show_as_an_address():
    sim = qc.Simulation("quadrotor", engine="eigen")
    log = sim.run(0.01)
    shown = [sim, sim.state, sim.model, sim.world, sim.snapshot(), log, qc.references.hover()(0)]
    shown += [*sim.model.links, *sim.model.joints, *sim.plugins, *sim.plugins[0].parameters]
    shown += [
        *sim.topics.values(),
        qc.controllers.geometric(),
        qc.references.spiral(),
        qc.InnerLoop(),
    ]
    shown += [qc.BatchSimulation(n=2), qc.FlightPlan.of(), qc.AttitudeThrust((0, 0, 0, 1), 1.0)]
    assert [repr(each) for each in shown if " at 0x" in repr(each)] == []
