"""A field of wind from a file, as RotorS' wind takes it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from faults import refusal
from fitted import X_FS, firefly_with, plugin
from scipy.interpolate import RegularGridInterpolator

# The firefly has an inertia that no body can have.
pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

MIN, STEP, SHAPE = (-4.0, -3.0), (4.0, 2.5), (3, 4)
SHARES = np.array([0, 0.2, 0.5, 1])
MEAN = np.array([0, 3, 0])  # m/s, where the field ends


def line(numbers):
    return " ".join(str(float(n)) for n in numbers)


def field(bottom, top, velocity):
    """Make a file's text; of arrays [x, y] and [x, y, z]."""
    rows = {
        "min_x": MIN[:1],
        "min_y": MIN[1:],
        "n_x": SHAPE[:1],
        "n_y": SHAPE[1:],
        "res_x": STEP[:1],
        "res_y": STEP[1:],
        "vertical_spacing_factors": SHARES,
        "bottom_z": bottom.ravel(order="F"),
        "top_z": top.ravel(order="F"),
        **{name: v.ravel(order="F") for name, v in zip("uvw", velocity)},
    }
    return "".join(f"{name}:\n{line(numbers)}\n" for name, numbers in rows.items())


@pytest.fixture
def chance():
    return np.random.default_rng(3)


@pytest.fixture
def make_firefly(tmp_path):
    """A maker of fireflies in a field."""

    def make(text, **tags):
        (tmp_path / "field.txt").write_text(text)
        given = {"windSpeedMean": 3, "windDirection": "0 1 0", "customWindFieldPath": "field.txt"}
        given.update(linkName="mast", useCustomStaticWindField="true", **tags)
        return firefly_with(tmp_path, plugin("wind", "wind_plugin", **given))

    return make


def measure_wind(simulation, place):
    """Wind at the position of the mast."""
    state = simulation.state.copy()
    state.position = np.asarray(place) - X_FS
    state.orientation = [0, 0, 0, 1]
    state.linear_velocity = state.angular_velocity = np.zeros(3)
    simulation.set_state(state)
    simulation.step(1)
    return np.array([simulation.topic("wind_speed")[axis] for axis in "xyz"])


def test_on_level_columns_a_field_is_the_trilinear_interpolation_of_its_points(
    make_firefly, chance
):
    velocity = chance.normal(size=(3, *SHAPE, 4))
    bottom, top = np.full(SHAPE, 2.0), np.full(SHAPE, 22.0)
    simulation = make_firefly(field(bottom, top, velocity))
    axes = [MIN[i] + STEP[i] * np.arange(SHAPE[i]) for i in range(2)]
    known = [RegularGridInterpolator((*axes, 2 + 20 * SHARES), v) for v in velocity]
    inside = np.array([4.0, 4.4, 21.9])
    for place in chance.uniform([-4, -3, 2.1], inside, size=(20, 3)):
        expected = [float(one(place)[0]) for one in known]
        assert np.allclose(measure_wind(simulation, place), expected, rtol=0, atol=1e-12)


def test_a_field_follows_the_terrain_and_ends_with_its_grid(make_firefly, chance):
    """Of a wind that grows with the share of the height, the same in all columns."""
    bottom = chance.uniform(0, 3, SHAPE)
    top = bottom + chance.uniform(10, 20, SHAPE)
    rising = np.broadcast_to(SHARES, (*SHAPE, 4))
    simulation = make_firefly(field(bottom, top, [8 * rising, 0 * rising, -2 * rising]))
    # Above a column's point, and between four: the mean of what it is in them.
    assert np.allclose(
        measure_wind(simulation, [0, -0.5, 9]),
        np.array([8, 0, -2]) * (9 - bottom[1, 1]) / (top - bottom)[1, 1],
        rtol=0,
        atol=1e-12,
    )
    shares = (9 - bottom[:2, :2]) / (top - bottom)[:2, :2]
    wind = measure_wind(simulation, [-2, -1.75, 9])
    assert np.allclose(wind, np.array([8, 0, -2]) * shares.mean(), rtol=0, atol=1e-12)
    for place in ([-4.1, 0, 9], [4.1, 0, 9], [0, -3.1, 9], [0, 4.6, 9], [0, 0, 40]):
        assert np.array_equal(measure_wind(simulation, place), MEAN)


def test_the_rotors_feel_a_field_and_nothing_pushes_beside_it(make_firefly):
    ones = np.ones((*SHAPE, 4))
    text = field(np.zeros(SHAPE), np.full(SHAPE, 50), [2 * ones, 0 * ones, 0 * ones])
    simulation = make_firefly(text, windForceMean=5)
    (said,) = [w for w in simulation.warnings if "together with a wind field" in w]
    assert "<windForceMean> has no effect" in said
    state = simulation.state.copy()
    state.rotor_velocity = 54 * np.array([1, -1, 1, -1, 1, -1])
    simulation.set_state(state)
    log = simulation.run(0.001, wrenches=True)
    assert log.wrenches["rotor_drag"][0][0] == pytest.approx(6 * 540 * 8.06428e-05 * 2, rel=1e-9)
    assert not log.wrenches["wind_force"].any()


GOOD = field(np.zeros(SHAPE), np.ones(SHAPE), np.zeros((3, *SHAPE, 4)))


@pytest.mark.parametrize(
    ("old", "new", "where", "says"),
    [
        (
            "n_x:\n3.0",
            "n_x:\n2.5",
            5,
            "n_x is not a valid number of points. Use a whole number from 2",
        ),
        ("res_x:\n4.0", "res_x:\n0", 9, "res_x is not positive. Use a positive distance in m"),
        ("res_y:", "rez_y:", 11, r"'rez_y' is not a quantity .*Did you mean 'res_y'\?"),
        ("0.2 0.5", "0.5 0.2", 13, "vertical_spacing_factors do not rise from 0 to 1. Write"),
        ("top_z:\n1.0", "top_z:\n-1.0", 17, "top_z of column 0.*not above its bottom_z. Use"),
        ("bottom_z:\n0.0", "bottom_z:\n", 15, "bottom_z has 11 numbers, but the grid requires 12"),
        ("u:\n0.0", "u:\nnan", 20, "'nan' is not a finite number. Write NAME:"),
        ("v:\n", "u:\n", 21, r"a second u \(first at .*field.txt:19\)\. Keep one"),
        ("min_x:\n", "", 1, "'-4.0' is not a finite number of a quantity. Write NAME:"),
        ("w:\n", "", None, "w is missing. Write w: followed by its numbers"),
    ],
)
def test_errors_in_a_wind_field_are_reported_with_their_line(make_firefly, old, new, where, says):
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    if old == "w:\n":
        text = GOOD[: GOOD.index("w:\n")]
    message = refusal(make_firefly, text)
    expected_line = f":{where}" if where else ""
    assert re.search(rf"'wind' .*field\.txt{expected_line}: {says}", message), message


def test_a_field_without_a_file_is_refused(make_firefly, tmp_path):
    for path, says in (
        ("", "<customWindFieldPath> is missing. Add the path"),
        ("elsewhere.txt", r"elsewhere\.txt: the file cannot be read. Give the path of an existing"),
    ):
        message = refusal(make_firefly, GOOD, **{"customWindFieldPath": path})
        assert re.search(says, message), message


def test_a_path_that_is_not_used_may_be_empty(tmp_path):
    tags = {"useCustomStaticWindField": "false", "customWindFieldPath": ""}
    firefly_with(tmp_path, plugin("wind", "wind_plugin", linkName="mast", **tags)).step(1)
