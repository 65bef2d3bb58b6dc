"""Wrong arguments of sweep and fit in Python."""

import pytest

import quadcore as qc


@pytest.fixture(scope="module")
def hover():
    """A flight under a constant command."""
    simulation = qc.Simulation("quadrotor", engine="eigen")
    simulation.command([471, -471, 471, -471])
    return simulation.run(2.0, log_every=10)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"vary": {"row": [1, 2]}}, "two columns 'row'"),
        ({"measures": ["failure"]}, "two columns 'failure'"),
        ({"measures": 3}, "measures is 3. Give a name, or several"),
        ({"vary": {"a": None}}, "Give a mapping of names to lists of values"),
        ({"controllers": "pd"}, "function replaces flights"),
        ({"vary": {"a": "uniform:0:1"}, "samples": 10**12}, "Give at most 1000000."),
        ({"vary": {"a": "uniform:0:1"}, "samples": 1, "design": "saltelli"}, "at least 2"),
        ({"executor": 3}, "executor is 3. Give what has submit()"),
        ({"points": 3}, "points is 3. Give a name or a path"),
        ({"seed": "a"}, "seed is 'a'. Give a whole number"),
    ],
)  # fmt: skip
def test_wrong_arguments_of_a_swept_function_are_refused_in_one_line(given, expected):
    with pytest.raises(qc.InputError) as refused:
        qc.sweep(**{"function": abs, "vary": {"a": [1, 2]}, **given})
    assert expected in str(refused.value) and "\n" not in str(refused.value)


def test_an_axis_named_seed_may_hold_any_number():
    found = qc.sweep(function=lambda point: point["seed"] ** 2, vary={"seed": [1.5, 2]})
    assert found.columns["value"].tolist() == [2.25, 4]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"free": ["xacro.motor"]}, "free xacro.motor: 'pid' is not a number. Only numbers can"),
        ({"free": None}, "free is None. Give a name, or several"),
        ({"horizon": 1e300}, "the log is shorter than a horizon"),
        ({"shift": 1e300}, "shift is 1e+300. Give seconds, from 0 to 10"),
        ({"channels": []}, "channels is []. Give some of position"),
        ({"bounds": {"frame.mass": 3}}, "Give a mapping of names to (lowest, highest)"),
        ({"log": 3}, "log is 3. Give a log, or its file"),
    ],
)  # fmt: skip
def test_wrong_arguments_of_a_fit_are_refused_in_one_line(hover, given, expected):
    with pytest.raises(qc.InputError) as refused:
        qc.fit("quadrotor", **{"log": hover, "free": ["frame.mass"], **given})
    assert expected in str(refused.value) and "\n" not in str(refused.value)


def test_a_flight_of_one_row_is_not_fitted():
    row = qc.Simulation("quadrotor", engine="eigen").run(0.0)
    with pytest.raises(qc.InputError, match="log: the log has 1 rows"):
        qc.fit("quadrotor", row, ["frame.mass"])
