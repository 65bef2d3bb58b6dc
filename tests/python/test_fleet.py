"""Several vehicles in one world: alone and together, controllers, snapshots, errors."""

from __future__ import annotations

import threading
import warnings

import numpy as np
import pytest

import quadcore as qc


def make_vehicle(z, engine="gazebo11", world=None, **options):
    return qc.Simulation(
        "quadrotor",
        engine=engine,
        world=world,
        spawn=(0, 0, z),
        xacro_args={"sim_slow": 1},
        **options,
    )


def quiet_fleet(*vehicles, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", qc.QuadcoreWarning)
        return qc.Fleet(named or list(vehicles))


@pytest.mark.parametrize("engine", ["gazebo11", "ode", "eigen"])
def test_each_vehicle_follows_its_own_reference_bit_for_bit_as_alone(engine):
    noise = {"parameters": {"odometry.positionNoise": 0.002}}
    fleet = quiet_fleet(
        a=make_vehicle(3, engine, "default.world", seed=1, **noise),
        b=make_vehicle(6, engine, "default.world", seed=2, **noise),
    )
    references = {"a": "circle:height=3", "b": "hover:height=6"}
    logs = fleet.run(1.0, controller="geometric", reference=references, on_reference=True)
    for seed, (name, log) in enumerate(logs.items(), 1):
        alone = make_vehicle(3 * seed, engine, "default.world", seed=seed, **noise).run(
            1.0, controller="geometric", reference=references[name], on_reference=True
        )
        assert log.position.tobytes() == alone.position.tobytes()
        assert log.topics["error"]["x"].tobytes() == alone.topics["error"]["x"].tobytes()


def drop(engine):
    """Let a vehicle fall on another one, which stands on the ground."""
    fleet = quiet_fleet(
        below=make_vehicle(0.05, engine, "default.world"),
        above=make_vehicle(0.6, engine, "default.world"),
    )
    return fleet, fleet.run(1.0)


@pytest.mark.parametrize("engine", ["gazebo11", "ode"])
def test_a_vehicle_that_falls_on_another_stays_above_it(engine):
    _, logs = drop(engine)
    assert (logs["above"].position[:, 2] > logs["below"].position[:, 2] + 0.01).all()
    alone = make_vehicle(0.05, engine, "default.world").run(1.0)
    assert logs["below"].position.tobytes() != alone.position.tobytes()


def test_a_snapshot_in_a_collision_restores_all_vehicles():
    fleet, logs = drop("gazebo11")
    fleet.reset()
    fleet.step(400)
    snapshot = fleet.snapshot()
    for _ in range(2):
        fleet.step(600)
        for name, log in logs.items():
            assert fleet.vehicles[name].state.position.tobytes() == log.position[-1].tobytes()
        fleet.restore(snapshot)
    assert fleet.time == pytest.approx(0.4)


def test_commands_hold_for_the_vehicle_that_receives_them():
    fleet = quiet_fleet(a=make_vehicle(5), b=make_vehicle(9))
    fleet.vehicles["a"].command(fleet.vehicles["a"].hover_speed)
    fleet.step(300)
    speeds = {
        name: abs(vehicle.state.rotor_velocity).max() for name, vehicle in fleet.vehicles.items()
    }
    assert speeds["a"] > 100 > speeds["b"]


class Fall:
    """A controller that ends its flight."""

    def __call__(self, t, state, reference):
        return [np.nan] * 4 if t > 0.1 else [0.0] * 4


def test_a_failure_names_the_vehicle_and_returns_all_logs():
    fleet = quiet_fleet(a=make_vehicle(5), b=make_vehicle(9))
    with pytest.raises(qc.FlightError, match="the controller returned") as failed:
        fleet.run(1.0, controller={"b": Fall()})
    assert failed.value.vehicle == "b"
    assert {name: len(log) for name, log in failed.value.logs.items()} == {"a": 103, "b": 103}


def test_a_vehicle_of_a_fleet_is_advanced_by_the_fleet_only():
    vehicle = make_vehicle(5)
    fleet = quiet_fleet(vehicle)
    for act in (vehicle.step, vehicle.reset, lambda: vehicle.restore(vehicle.snapshot())):
        with pytest.raises(qc.InputError, match=r"this vehicle belongs to a fleet. Use Fleet\."):
            act()
    with pytest.raises(qc.InputError, match=r"Use Fleet\.run"):
        vehicle.run(1.0)
    with pytest.raises(qc.InputError, match="already belongs to a fleet"):
        qc.Fleet([vehicle])
    assert fleet.names == ["quadrotor"]


@pytest.mark.parametrize(
    "control", [{}, {"controller": "geometric", "reference": "hover"}], ids=str
)
def test_progress_ends_with_the_last_step(control):
    reports = {}
    makers = {"fleet": lambda: quiet_fleet(make_vehicle(5)), "vehicle": lambda: make_vehicle(5)}
    for name, make in makers.items():
        of_one = reports[name] = []
        make().run(0.02, progress=lambda *report, into=of_one: into.append(report), **control)
    assert reports["fleet"][-1] == reports["vehicle"][-1] == (20, 20)


def test_a_vehicle_of_a_fleet_has_the_time_of_the_fleet():
    vehicle = make_vehicle(5)
    fleet = quiet_fleet(vehicle, make_vehicle(9))
    fleet.step(20)
    state = vehicle.state.copy()
    state.position = [1, 2, 3]
    state.time = 100
    with pytest.raises(qc.InputError, match=r"time is 100, but its fleet is at 0\.02 s\. Set "):
        vehicle.set_state(state)
    assert vehicle.state.position[0] == 0
    state.time = fleet.time
    vehicle.set_state(state)
    assert vehicle.state.position.tolist() == [1, 2, 3]
    assert {each.time for each in fleet.vehicles.values()} == {fleet.time}


def test_vehicles_of_different_worlds_form_no_fleet():
    with pytest.raises(qc.InputError, match=r"vehicle 'quadrotor_2': its world is not that"):
        qc.Fleet([make_vehicle(5), make_vehicle(9, world="default.world")])
    with pytest.raises(qc.InputError, match=r"its step is not that"):
        qc.Fleet([make_vehicle(5), make_vehicle(9, dt=0.002)])
    with pytest.raises(qc.InputError, match="its engine is not that"):
        qc.Fleet([make_vehicle(5), make_vehicle(9, "ode")])


def test_eigen_warns_that_vehicles_pass_through_each_other():
    with pytest.warns(qc.QuadcoreWarning, match="the vehicles pass through each other"):
        qc.Fleet([make_vehicle(5, "eigen"), make_vehicle(9, "eigen")])


def test_names_of_arguments_are_those_of_vehicles():
    fleet = quiet_fleet(a=make_vehicle(5), b=make_vehicle(9))
    with pytest.raises(qc.InputError, match=r"controller: no vehicle has the name 'c'. Use a, b."):
        fleet.run(1.0, controller={"c": "geometric"})
    with pytest.raises(qc.InputError, match="one object for several vehicles"):
        fleet.run(1.0, controller=Fall())


def test_warnings_cannot_be_read_while_another_thread_writes_them():
    fleet = quiet_fleet(make_vehicle(3), make_vehicle(6))
    flying = threading.Thread(target=fleet._advance, args=(50000, []))
    flying.start()
    while fleet.time == 0:
        pass
    with pytest.raises(qc.InputError, match="is in use by another thread"):
        _ = fleet.warnings
    flying.join()
    assert fleet.warnings == []
