"""Models, worlds and snapshots travel: another process flies the same bytes."""

from __future__ import annotations

import os
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from flights import BUSY, ENGINES, bits, digest, fly_in_process, hold_height, quadrotor

import quadcore as qc


@pytest.fixture
def flat(toy):
    """The toy, read; its files are gone."""
    model, world = qc.read_model("toy.urdf"), qc.read_world("toy.world")
    os.remove("toy.urdf")
    os.remove("toy.world")
    return model, world


# What travels


def test_model_and_world_fly_elsewhere_without_their_files(flat):
    source = (
        "import quadcore as qc\n"
        "def fly(model, world):\n"
        "    return qc.Simulation(model, 'eigen', world).run(0.2).table.tobytes()\n"
    )
    scope = {}
    exec(source, scope)
    assert fly_in_process(source, *flat) == digest(scope["fly"](*flat))


def test_a_model_that_travelled_says_the_same_of_itself(toy):
    text = (
        Path("toy.urdf").read_text().replace("</robot>", "<odd/><gazebo><blob/></gazebo></robot>")
    )
    Path("odd.urdf").write_text(text)
    model = qc.read_model("odd.urdf", ignore=["odd", "blob"])
    again = pickle.loads(pickle.dumps(model))
    assert [link.where for link in again.links] == [link.where for link in model.links]
    assert again.ignored_elements.ignored == ["odd", "blob"]
    assert qc.Simulation(again, world="toy.world").ignored == ["odd", "blob"]
    expanded = qc.read_model("quadrotor", {"sim_slow": 3})
    again = pickle.loads(pickle.dumps(expanded))
    assert again.document.lines == expanded.document.lines
    assert [joint.where for joint in again.joints] == [joint.where for joint in expanded.joints]


def test_a_model_as_gazebo_rounds_it_does_not_pass_for_the_one_that_was_read():
    with pytest.raises(qc.InputError, match=r"was rounded by its engine\. Pickle the model"):
        pickle.dumps(quadrotor("gazebo11").model)
    assert pickle.loads(pickle.dumps(quadrotor("eigen").model)).name == "quadrotor"


@pytest.mark.parametrize("engine", ENGINES)
def test_a_snapshot_flies_on_elsewhere_as_here(engine):
    source = (
        "import quadcore as qc\n"
        f"from flights import BUSY, hold_height\n"
        "def fly(snapshot):\n"
        f"    sim = qc.Simulation('quadrotor', engine='{engine}', parameters=BUSY)\n"
        "    sim.restore(snapshot)\n"
        "    return hold_height(sim, 200)\n"
    )
    simulation = quadrotor(engine, parameters=BUSY)
    hold_height(simulation, 333)
    elsewhere = fly_in_process(source, simulation.snapshot())
    assert elsewhere == digest(hold_height(simulation, 200))


def test_a_snapshot_of_a_failed_flight_tells_the_failure_elsewhere():
    unlimited = {"motorpid_plugin.maxVelocity": 1e301}
    simulation = quadrotor("eigen", parameters=unlimited)
    with pytest.raises(qc.FlightError):
        simulation.run(1, [[0, 471, -471, 471, -471], [0.1, *[1e300] * 4]])
    other = quadrotor("eigen", parameters=unlimited)
    other.restore(pickle.loads(pickle.dumps(simulation.snapshot())))
    with pytest.raises(qc.FlightError, match="To continue, call reset, restore or set_state"):
        other.step()
    assert other.time == simulation.time


def test_a_damaged_or_foreign_pickle_is_refused():
    simulation = quadrotor("eigen")
    snapshot = simulation.snapshot()
    before = bits(simulation)
    make, (kind, *_), state, *_ = snapshot.__reduce_ex__(2)

    def restore(**changed):
        damaged = make(kind)
        damaged.__setstate__({**state, **changed})
        simulation.restore(damaged)

    for changed, says in (
        ({"version": 99}, "pickled by another version of quadcore. Take it again"),
        ({"messages": []}, "its messages belong to other topics. Take a new snapshot"),
        (
            {"messages": [(m[0][1:], m[1], m[2]) for m in state["messages"]]},
            "belong to other topics",
        ),
        ({"plugins": np.zeros(1)}, "is damaged. Take a new snapshot"),
        ({"engine": np.zeros(1)}, "another model or engine"),
    ):
        with pytest.raises(qc.InputError, match=says):
            restore(**changed)
    assert bits(simulation) == before
    restore()


# What differs


def refuse_restore(restored, taken, **allowed):
    with pytest.raises(qc.InputError) as refused:
        restored.restore(taken.snapshot(), **allowed)
    text = str(refused.value)
    assert text.startswith("snapshot: it was taken with a different ")
    assert "\n" not in text
    return text


def test_what_a_snapshot_differs_in_is_said(toy):
    world = Path("toy.world").read_text()
    Path("windy.world").write_text(world.replace("1 0 0", "0 3 0"))
    Path("heavy.urdf").write_text(
        Path("toy.urdf").read_text().replace('mass value="1"', 'mass value="1.25"')
    )
    plain = qc.Simulation("toy.urdf", world="toy.world")

    def like_it(model="toy.urdf", world="toy.world", **options):
        return qc.Simulation(model, world=world, **options)

    plain.restore(like_it().snapshot())
    plain.restore(like_it(seed=5).snapshot())
    found = refuse_restore(plain, like_it(engine="eigen"))
    assert (
        "a different engine ('eigen' there, 'gazebo11' here). Restore a snapshot of this sim"
        in found
    )
    assert "a different step ('0.002' there, '0.001' here)" in refuse_restore(
        plain, like_it(dt=0.002)
    )
    found = refuse_restore(plain, like_it("heavy.urdf"))
    masses = "'link frame mass 1.250002' there, 'link frame mass 1.000002' here"
    assert f"a different model ({masses})." in found
    found = refuse_restore(plain, like_it(world="windy.world"))
    assert "a different world ('wind 0 3 0' there, 'wind 1 0 0' here)" in found
    assert found.endswith(", or allow world to differ.")
    found = refuse_restore(plain, like_it(parameters={"motor.kp": 1e-3}))
    assert "a different set of parameters ('motor.kp 0.001' there, 'motor.kp 0.0005' here)" in found
    both = like_it(world="windy.world", parameters={"motor.kp": 1e-3})
    assert "a different world" in refuse_restore(
        plain, both
    ) and "a different set of parameters" in refuse_restore(plain, both)
    assert "a different world" not in refuse_restore(plain, both, allow=["world"])
    found = refuse_restore(
        plain, like_it("heavy.urdf", "windy.world"), allow=("world", "parameters")
    )
    assert "a different model" in found and "world" not in found.split("a different")[1]


def test_another_world_or_parameter_is_taken_on_purpose(toy):
    Path("windy.world").write_text(Path("toy.world").read_text().replace("1 0 0", "0 3 0"))
    taken = qc.Simulation("toy.urdf", world="toy.world")
    taken.command([300])
    taken.step(100)
    options = {"world": "windy.world", "parameters": {"motor.kp": 1e-3}}
    onto = qc.Simulation("toy.urdf", **options)
    onto.restore(taken.snapshot(), allow=("world", "parameters"))
    assert bits(onto) == bits(taken)
    for simulation in (taken, onto):
        simulation.step(100)
    assert bits(onto) != bits(taken)


@pytest.mark.parametrize(
    "tag",
    ["drone_plugin.rotorThrustCoeff", "drone_plugin.inducedDragCoeff", "motorpid_plugin.kp"],
)
@pytest.mark.parametrize("engine", ENGINES)
def test_a_parameter_taken_on_purpose_acts_from_then_on(engine, tag):
    """As in a simulation that was put into the same state."""
    taken, changed = quadrotor(engine), {tag: 7e-6}
    taken.set_state(start_moving(taken))
    onto, made = quadrotor(engine, parameters=changed), quadrotor(engine, parameters=changed)
    onto.restore(taken.snapshot(), allow=["parameters"])
    made.set_state(start_moving(made))
    for simulation in (taken, onto, made):
        simulation.command([480, -470, 490, -475])
        simulation.step(50)
    assert bits(onto) == bits(made) != bits(taken)


def start_moving(simulation):
    state = simulation.state.copy()
    state.linear_velocity[:] = 3, -2, 1
    state.rotor_velocity[:] = 47, -47, 47, -47
    return state


@pytest.mark.parametrize("name", ["engine", "model", "step", "plugins", "wordl", ""])
def test_nothing_else_may_differ_on_purpose(name):
    simulation = quadrotor("eigen")
    with pytest.raises(qc.InputError, match=f"allow '{name}': this part may not differ"):
        simulation.restore(simulation.snapshot(), allow=[name])
    with pytest.raises(TypeError):
        simulation.restore(simulation.snapshot(), ["world"])


def test_the_same_parameters_written_otherwise_are_the_same():
    simulation = quadrotor("eigen", parameters={"motorpid_plugin.kd": "0.0010"})
    simulation.restore(quadrotor("eigen", parameters={"motorpid_plugin.kd": 1e-3}).snapshot())


def test_a_parameter_that_is_absent_is_not_zero():
    absent, zero = quadrotor("eigen"), quadrotor("eigen", parameters={"odometry.seed": 0})
    assert "'odometry.seed 0' there, 'odometry.seed' here" in refuse_restore(absent, zero)


# Numbers that say how fast a window would run, and those that stand in parts of their own.
NOT_FELT = re.compile(r"real_time|max_step_size|version|<(kp|kd|ki|rate|sim_slow|rotor\w*)>")


@pytest.mark.filterwarnings("ignore:.*has a physically impossible inertia")
@pytest.mark.parametrize("name", ["toy.urdf", "toy.world"])
def test_every_number_that_is_felt_counts(toy, name):
    """Each number of the toy, changed alone, makes another model or world."""
    files = {"model": "toy.urdf", "world": "toy.world"}
    kind = next(key for key, file in files.items() if file == name)
    plain, text, counted = qc.Simulation(**files), Path(name), 0
    source = text.read_text()
    for number in re.finditer(r'(?<=[ ">])-?[0-9.]+(e-?[0-9]+)?(?=[ "<])', source):
        line = source[source.rfind("\n", 0, number.start()) + 1 : source.find("\n", number.end())]
        if NOT_FELT.search(line) or float(number[0]) == 0:
            continue
        value = float(number[0])
        value = value + 1 if value.is_integer() and "iters" in line else value * 1.03
        changed = Path("changed" + text.suffix)
        changed.write_text(f"{source[: number.start()]}{value!r}{source[number.end() :]}")
        try:
            other = qc.Simulation(**{**files, kind: str(changed)})
        except qc.InputError as refused:  # an sor or an erp that is none
            assert "range" in str(refused)
            continue
        if "<axis" in line:  # of unit length again
            continue
        assert f"a different {kind}" in refuse_restore(plain, other), line
        counted += 1
    assert counted >= 5
