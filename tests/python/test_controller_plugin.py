"""Controllers and references as plugins."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from hooked import G, with_plugins
from vehicles import CROSS, DRAG, LIFT, MOTOR, plugin, vehicle

import quadcore as qc
from quadcore.control import controllers, references

NOISY = {
    "positionNoise": 1e-3,
    "orientationNoise": 1e-3,
    "linearVelocityNoise": 1e-2,
    "angularVelocityNoise": 1e-2,
}
CIRCLE = {"shape": "circle", "radius": 1.2, "rate": 1.3, "yaw_rate": 0.2}


def bare(odometry=NOISY):
    return with_plugins(
        vehicle(CROSS, air={**LIFT, **DRAG}, motor=MOTOR), plugin("odometry", odometry)
    )


def guide(controller, reference=CIRCLE, odometry=NOISY):
    return with_plugins(
        bare(odometry), plugin("controller", controller), plugin("reference", reference)
    )


def circle():
    return references.circle(**{name: x for name, x in CIRCLE.items() if name != "shape"})


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    "timing", [{}, {"rate": 300}, {"delay": 0.005}, {"rate": 170, "delay": 0.0131}]
)
def test_a_controller_as_plugin_and_from_python_is_one_flight(engine, timing, hangar):
    plugged = hangar(guide({"law": "geometric", "kp_xy": 7, **timing}), G, engine=engine)
    called = hangar(bare(), G, engine=engine)
    for simulation in (plugged, called):
        simulation.set_state(references.start(simulation, circle()))
    controller = controllers.geometric(kp_xy=7, **timing)
    one = plugged.run(1)
    other = called.run(1, controller=controller, reference=circle())
    assert one.table.tobytes() == other.table.tobytes()


@pytest.mark.parametrize("controller", controllers.NAMES)
def test_a_flight_goes_on_from_a_snapshot_bit_for_bit_with_every_controller(controller, hangar):
    urdf = guide({"law": controller, "delay": 0.007, "rate": 230})
    first, second = (hangar(urdf, G, engine="eigen", spawn=(1, 0, 10)) for _ in range(2))
    first.run(0.3)
    snapshot = first.snapshot()
    expected = first.run(0.4)
    second.restore(snapshot)
    assert second.run(0.4).table.tobytes() == expected.table.tobytes()
    first.reset()
    first.run(0.3)
    assert first.run(0.4).table.tobytes() == expected.table.tobytes()


def test_a_controller_beside_one_that_is_a_plugin_is_bad_input(hangar):
    simulation = hangar(guide({"law": "pd"}), G, engine="eigen")
    with pytest.raises(qc.InputError, match=r"vel_cmd.*controller"):
        simulation.run(0.1, controller=lambda *_: [0] * 4)
    assert simulation.time == 0


def test_velocities_in_the_body_are_understood(hangar):
    logs = []
    for frame in ("world", "body"):
        tags = {"law": "geometric", "twistFrame": frame}
        simulation = hangar(guide(tags, odometry={"twistFrame": frame}), G, engine="eigen")
        simulation.set_state(references.start(simulation, circle()))
        logs.append(simulation.run(2))
    assert np.abs(logs[0].position - logs[1].position).max() < 1e-9
    with pytest.raises(qc.InputError, match="twistFrame"):
        hangar(guide({"law": "pd"}, odometry={"twistFrame": "body"}), G)


def test_a_controller_has_the_model_of_a_second_file(tmp_path, hangar):
    heavier = vehicle(CROSS, mass=1.2, com=(0.01, 0, 0), air={**LIFT, **DRAG}, motor=MOTOR)
    believed = tmp_path / "believed.urdf"
    # Its own controller would ask for a third one.
    believed.write_text(
        with_plugins(heavier, plugin("controller", {"law": "pd", "belief": believed}))
    )
    plugged = hangar(guide({"law": "geometric", "belief": believed}), G, engine="ode")
    called = hangar(bare(), G, engine="ode")
    controller = controllers.geometric(belief=hangar(heavier, G, engine="eigen"))
    one = plugged.run(0.5)
    other = called.run(0.5, controller=controller, reference=circle())
    assert one.table.tobytes() == other.table.tobytes()
    believed.write_text(vehicle(CROSS[:3], air=LIFT, motor=MOTOR))
    with pytest.raises(qc.InputError, match="has 3 rotors, but the simulated vehicle has 4"):
        hangar(guide({"law": "geometric", "belief": believed}), G)


@pytest.mark.parametrize("shape", ["waypoints", "series"])
@pytest.mark.parametrize("kind", ["csv", "yaml"])
def test_a_reference_of_rows_is_read_from_a_file(shape, kind, tmp_path, hangar):
    rows = [[0, 0, 0, 10, 0.1], [4, 0.5, 0, 10.2, 0.2], [10, 0.7, -0.3, 10.1, -0.1]]
    path = tmp_path / f"rows.{kind}"
    if kind == "csv":
        lines = ["t, x, y, z, yaw", *(",".join(map(str, row)) for row in rows)]
    else:
        lines = ["columns: [t, x, y, z, yaw]", "rows:", *(f"  - {row}" for row in rows)]
    path.write_text("\n".join(lines))
    simulation = hangar(guide({"law": "pd"}, {"shape": shape, "rows": path}), G, engine="eigen")
    wanted = getattr(references, shape)(rows)
    assert np.array_equal(getattr(references, shape)(path).rows, wanted.rows)
    for _ in range(20):
        simulation.step(400)
        said, meant = simulation.topic("reference"), wanted(simulation.time - simulation.dt)
        assert [said["ax"], said["ay"], said["az"]] == pytest.approx(list(meant.acceleration))
        assert said["yaw"] == pytest.approx(meant.yaw)


@pytest.mark.parametrize(
    ("name", "text", "says"),
    [
        ("rows.csv", "t,x,y\n", "rows.csv:1: the header is 't,x,y'. Use t,x,y,z"),
        ("rows.csv", "t,x,y,z\n0,0,0,1\n1,0,0\n", "rows.csv:3: 3 columns instead of 4"),
        ("rows.csv", "t,x,y,z\n0,0,nan,1\n", "rows.csv:2: 'nan' is not a finite number"),
        ("rows.csv", "t,x,y,z\n0,0,0,1,\n1,0,0,1\n", "rows.csv:2: 5 columns instead of 4"),
        ("rows.csv", "t,x,y,z\n0,0,0,1\n\n0,0,0,1\n", "rows.csv:4: the row is not later than"),
        ("rows.csv", "t,x,y,z\n0,0,0,1\n", "rows.csv: the file has fewer than two rows"),
        (
            "rows.yaml",
            "columns: {a: 1}\nrows: []\n",
            r"rows.yaml:1: 'columns' is invalid. Write `columns: \[t, x",
        ),
        (
            "rows.yaml",
            "columns: [t, x, y, z]\nrows:\n  - [1, 0, 0, 1]\n  - [0, 0, 0, 1]\n",
            "rows.yaml:4: the row is not later than the row before",
        ),
        ("rows.yaml", "rows: []\n", r"rows.yaml:1: 'columns' is invalid. Write `columns: \[t, x"),
        ("rows.yaml", "columns: [t, x, y, z]\n", "rows.yaml:1: 'rows' is not a list"),
        (
            "rows.yaml",
            "columns: [t, x, y, z]\nrows:\n  - [0, 1]\n",
            "rows.yaml:3: the row does not have 4",
        ),
        (
            "rows.yaml",
            "columns: [t, x, y, z]\nrows:\n  - [0, a, 0, 1]\n",
            "rows.yaml:3: 'x' is 'a'",
        ),
        ("rows.yaml", "columns: [t, x, y, z]\nrow: 1\n", "rows.yaml:2: unknown key 'row'"),
        ("rows.txt", "t,x,y,z\n", "rows can be read only from .csv and .yaml files"),
    ],
)
def test_rows_that_cannot_be_read_are_reported_with_their_line(name, text, says, tmp_path, hangar):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(qc.InputError, match=says):
        hangar(guide({"law": "pd"}, {"shape": "waypoints", "rows": path}), G)


def test_a_log_is_a_series_with_the_yaw_of_its_orientation(hangar, tmp_path):
    simulation = hangar(bare({}), G, engine="eigen")
    simulation.set_state(references.start(simulation, circle()))
    log = simulation.run(6, controller="geometric", reference=circle(), log_every=10)
    log.to_csv(tmp_path / "log.csv")
    flown = references.series(tmp_path / "log.csv")
    for t in (1.3, 2.9, 4.4):
        assert np.linalg.norm(flown(t).position - circle()(t).position) < 1e-3
        assert np.linalg.norm(flown(t).acceleration - circle()(t).acceleration) < 0.05
        assert flown(t).yaw == pytest.approx(0.2 * t, abs=1e-3)
    again = hangar(bare({}), G, engine="eigen")
    again.set_state(references.start(again, flown))
    second = again.run(6, controller="geometric", reference=flown, log_every=10)
    assert np.abs(second.position - log.position).max() < 1e-3


def test_rows_and_shapes_that_need_none_are_distinguished(hangar, tmp_path):
    with pytest.raises(qc.InputError, match="'waypoints' requires rows"):
        hangar(guide({"law": "pd"}, {"shape": "waypoints"}), G)
    rows = tmp_path / "rows.csv"
    rows.write_text("t,x,y,z\n0,0,0,1\n1,0,0,1\n")
    with pytest.raises(qc.InputError, match="'hover' accepts no rows"):
        hangar(guide({"law": "pd"}, {"shape": "hover", "rows": rows}), G)


def test_the_reference_stands_on_its_topic(hangar):
    simulation = hangar(guide({"law": "pd"}), G, engine="eigen")
    simulation.step(5)
    said, wanted = simulation.topic("reference"), circle()(0.004)
    assert said["stamp"] == pytest.approx(0.004)
    assert [said[name] for name in ("x", "y", "z")] == pytest.approx(list(wanted.position))
    assert said["yaw_rate"] == 0.2


@pytest.mark.parametrize(
    ("controller", "reference", "says"),
    [
        ({"law": "pdd"}, CIRCLE, "pdd"),
        (
            {"law": "geometric", "scale": 2},
            CIRCLE,
            "controller 'geometric' has no parameter 'scale'",
        ),
        ({"law": "pd", "kp_xy": -1}, CIRCLE, "<kp_xy>"),
        ({"law": "pd", "spins": "1 1 -1"}, CIRCLE, "the spins are not 4 signs"),
        ({"law": "pd"}, {"shape": "hover", "radius": 1}, "'hover' has no parameter 'radius'"),
    ],
)
def test_what_no_controller_is_made_of_is_refused(controller, reference, says, hangar):
    with pytest.raises(qc.InputError, match=says):
        hangar(guide(controller, reference), G)
