"""References that are no shapes of quadcore: functions, and what they may give."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import quadcore as qc

MEMBERS = {
    "position": (1.0, -2.0, 11.0),
    "velocity": (0.1, 0.2, -0.3),
    "acceleration": (0.02, 0.01, 0.03),
    "jerk": (0.0, 0.1, 0.0),
    "snap": (0.0, 0.0, 0.2),
    "yaw": 0.4,
    "yaw_rate": -0.1,
    "yaw_acceleration": 0.05,
}


def test_a_reference_is_made_of_its_members():
    made = qc.Reference(**MEMBERS)
    for name, value in MEMBERS.items():
        assert np.array_equal(getattr(made, name), value), name
    assert np.array_equal(qc.Reference(yaw=0.4).position, [0, 0, 0])


@pytest.mark.parametrize(
    "name, value, expected",
    [
        ("snap", (1.0, 2.0), "reference.snap has 2 numbers. Give 3."),
        ("yaw_rate", "fast", "reference.yaw_rate"),
        ("yaw", (1.0, 2.0), "reference.yaw"),
    ],
)
def test_a_wrong_member_is_reported_in_one_line(name, value, expected):
    with pytest.raises(qc.InputError, match=expected) as error:
        qc.Reference(**{**MEMBERS, name: value})
    assert "\n" not in str(error.value)


def test_an_object_with_the_members_of_a_reference_guides_a_controller_as_one_does():
    logs = [
        qc.Simulation("quadrotor", engine="eigen").run(
            0.2, controller="geometric", reference=lambda t, kind=kind: kind(**MEMBERS), **begins
        )
        for kind in (qc.Reference, SimpleNamespace)
        for begins in ({}, {"on_reference": True})
    ]
    assert np.array_equal(logs[0].table, logs[2].table)
    assert np.array_equal(logs[1].table, logs[3].table)
    assert not np.array_equal(logs[0].table, logs[1].table)


@pytest.mark.parametrize("controller", ["geometric", lambda t, state, reference: [400.0] * 4])
@pytest.mark.parametrize("given", [(0, 0, 10), None, {"position": (0, 0, 10)}])
def test_an_object_that_is_no_reference_is_refused_in_one_line(controller, given):
    simulation = qc.Simulation("quadrotor")
    with pytest.raises(qc.QuadcoreError) as error:
        simulation.run(0.1, controller=controller, reference=lambda t: given)
    assert "\n" not in str(error.value)
    assert "Give a quadcore.Reference" in str(error.value)


@pytest.mark.parametrize(
    "name, value, expected",
    [
        ("snap", None, "the reference has no member snap. Give a quadcore.Reference"),
        ("jerk", (1.0, 2.0), "reference.jerk has 2 numbers. Give 3."),
    ],
)
def test_a_missing_member_of_a_controller_is_named(name, value, expected):
    members = {**MEMBERS, name: value}
    if value is None:
        del members[name]
    with pytest.raises(qc.QuadcoreError, match=expected) as error:
        qc.Simulation("quadrotor").run(
            0.1, controller="pd", reference=lambda t: SimpleNamespace(**members)
        )
    assert "\n" not in str(error.value)


def test_a_fault_inside_a_reference_is_its_own():
    def raise_error(t):
        return t.nothing

    with pytest.raises(AttributeError, match="nothing"):
        qc.Simulation("quadrotor").run(0.1, controller="pd", reference=raise_error)
