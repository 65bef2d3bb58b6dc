"""reference.at: the reference at other times, for controllers that look ahead."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

import quadcore as qc

MEMBERS = ("position", "velocity", "acceleration", "jerk", "snap")
SCALARS = ("yaw", "yaw_rate", "yaw_acceleration")


def look(reference, times=None):
    """What a controller finds at its second call: its reference, and `at` of some times."""
    seen = []

    def controller(t, state, wanted):
        seen.append((t, wanted, None if times is None else wanted.at(t + np.asarray(times))))
        return [471, -471, 471, -471]

    sim = qc.Simulation("quadrotor", engine="eigen")
    sim.run(0.01, controller=controller, reference=reference)
    return seen[1]


def rows(tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("t,x,y,z,yaw\n0,0,0,10,0\n2,1,0,11,0.5\n4,1,2,10,1\n")
    return str(path)


@pytest.mark.parametrize("name", ["circle", "takeoff_land", "step", "eight:along=true", "rows"])
def test_built_in_references_and_files_are_known_ahead(name, tmp_path):
    shape = qc.references.parse(rows(tmp_path) if name == "rows" else name)
    shape = shape.on(qc.Simulation("quadrotor", engine="eigen"))
    ahead = np.array([[0.0, 0.3, 1.1], [2.0, 3.7, 9.0]])
    t, now, then = look(shape, ahead)
    assert np.array_equal(now.position, shape(t).position)
    for index in np.ndindex(ahead.shape):
        wanted = shape(t + ahead[index])
        for member in MEMBERS:
            assert np.array_equal(getattr(then, member)[index], getattr(wanted, member))
        for member in SCALARS:
            assert getattr(then, member)[index] == getattr(wanted, member)
    assert then.yaw.shape == ahead.shape and then.snap.shape == (2, 3, 3)


def test_one_time_gives_one_reference():
    circle = qc.references.circle()
    t, _, then = look(circle, 0.5)
    assert isinstance(then, qc.Reference)
    assert np.array_equal(then.velocity, circle(t + 0.5).velocity)
    assert np.array_equal(circle.at(2.0).position, circle(2.0).position)
    assert circle.at([1, 2]).position.shape == (2, 3)


def test_a_reference_of_the_user_is_known_ahead():
    def climb(t):
        return qc.Reference(position=(0, 0, 10 + 0.5 * t), velocity=(0, 0, 0.5), yaw=0.3 * t)

    t, _, then = look(climb, [0, 1, 2])
    assert then.position[:, 2] == pytest.approx(10 + 0.5 * (t + np.arange(3)))
    assert then.yaw == pytest.approx(0.3 * (t + np.arange(3)))
    assert then.velocity.tolist() == [[0, 0, 0.5]] * 3


def test_objects_with_some_members_only_are_passed_on_with_their_future():
    @dataclass(frozen=True)
    class Point:
        position: tuple
        yaw: float
        marker: str = "mine"

    t, now, then = look(lambda t: Point((math.sin(t), 0, 10), t), [0, 0.5])
    assert (now.marker, now.yaw) == ("mine", t)
    assert now.at(1.0).position == (math.sin(1), 0, 10)
    assert then.position[:, 0] == pytest.approx(np.sin([t, t + 0.5]))
    assert not hasattr(then, "velocity")


def test_a_controller_that_wraps_a_built_in_one_still_flies():
    inner = qc.controllers.geometric()

    class Outer:
        def reset(self, sim):
            inner.reset(sim)

        def __call__(self, t, state, reference):
            return inner(t, state, reference.at(t))

    logs = []
    for controller in (Outer(), qc.controllers.geometric()):
        sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
        logs.append(sim.run(1, controller=controller, reference="circle", on_reference=True))
    assert np.array_equal(logs[0].position, logs[1].position)


@pytest.mark.parametrize("time", ["soon", math.nan, [0, math.inf]])
def test_what_is_no_time_is_refused(time):
    with pytest.raises(qc.InputError, match=r"reference.at: the time is .* Give seconds"):
        qc.references.circle().at(time)
