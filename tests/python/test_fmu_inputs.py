"""What acts on an FMU while nobody sets its inputs, which is what they declare."""

import itertools

import pytest
from flights import HOVER, with_pilot
from imported import Imported

import quadcore as qc
from quadcore.model import resources

pytest.importorskip("fmpy")

LAB = {
    "payload": "<mass>0.2</mass><xyz>0.1 0 0</xyz><release>0.02</release>",
    "later": "<mass>0.1</mass><topic>later</topic><pickUp>0.03</pickUp>",
    "push": "<link>propeller2</link>",
    "fault": "",
}


def with_all_that_listens(folder):
    """Copy the quadrotor with every kind of plugin that its caller tells something."""
    text = (resources.find_root() / "urdf/quadrotor.urdf.xacro").read_text()
    parts = "".join(
        f'<gazebo><plugin name="{name}" filename="lib'
        f'{"payload" if name == "later" else name}_plugin.so">{tags}</plugin></gazebo>'
        for name, tags in LAB.items()
    )
    model = folder / "lab.urdf.xacro"
    model.write_text(text.replace("</robot>", parts + "</robot>"))
    return str(model)


@pytest.fixture(scope="module")
def fmus(tmp_path_factory):
    """Maker of FMUs by the name of their model, each once."""
    folder, made = tmp_path_factory.mktemp("fmus"), {}

    def make(model, engine="eigen"):
        if (model, engine) not in made:
            special = {"lab": with_all_that_listens, "piloted": lambda f: with_pilot(f / "pilot")}
            path = made[model, engine] = folder / f"{model}_{engine}.fmu"
            qc.export_fmu(path, special[model](folder) if model in special else model,
                          engine=engine)  # fmt: skip
        return made[model, engine]

    return make


@pytest.fixture
def import_fmu(fmus, tmp_path):
    """Maker of instances, which end with the test."""
    made, folders = [], (tmp_path / str(i) for i in itertools.count())

    def make(*arguments, **options):
        made.append(Imported(fmus(*arguments), next(folders), **options))
        return made[-1]

    yield make
    for instance in made:
        instance.close()


def starts(instance, without=()):
    inputs = (v for v in instance.variables.values() if v.causality == "input")
    return {v.name: float(v.start) for v in inputs if v.name not in without}


def set_all(instance, values):
    for name, value in values.items():
        instance.set(name, value)


def outputs(instance):
    return repr(instance.get(*(
        v.name for v in instance.variables.values() if v.causality == "output"
    )))  # fmt: skip


def rows(instance, speeds=None, pieces=4, length=0.02, each=lambda: None):
    """Every bit of all outputs on the way; not even NaN differs."""
    values = []
    for _ in range(pieces):
        if speeds is not None:
            instance.command(speeds)
        each()
        instance.step(length)
        values.append(outputs(instance))
    return values


def test_motors_turn_whose_other_inputs_are_set_to_their_declared_starts(import_fmu):
    """As by an importer that applies them all."""
    alone, applied = (import_fmu("quadrotor", "gazebo11") for _ in range(2))
    motors = ("w1", "w2", "w3", "w4")
    others = starts(applied, without=motors)
    assert others == {f"{t}.s{i}": 1.0 for t in ("effectiveness", "power") for i in (1, 2, 3, 4)}
    set_all(applied, others)
    heights = []
    for instance in (alone, applied):
        instance.command(HOVER)
        instance.step(1.0)
        heights += instance.get("z")
    assert heights[0] == heights[1] == pytest.approx(9.2326, abs=1e-4)


MODELS = ["quadrotor", "hexarotor", "neo11", "crazyflie", "ardrone", "firefly", "hummingbird",
          "iris", "pelican", "lab", "piloted"]  # fmt: skip


@pytest.mark.parametrize("commanded", [False, True])
@pytest.mark.parametrize("model", MODELS)
def test_inputs_that_are_set_to_their_declared_starts_fly_as_if_nobody_had(
    model, commanded, import_fmu
):
    """Before the initialisation, after it, and shares and pushes anew at each step."""
    untouched, before, after, always = (import_fmu(model, initialise=False) for _ in range(4))
    motors = [name for name in starts(before) if name[0] == "w" and name[1:].isdigit()]
    speeds = [400.0, -410.0, 420.0, -430.0, 415.0, -405.0][: len(motors)] if commanded else None
    if commanded and not motors:
        pytest.skip("nobody but its plugin commands it")
    own = starts(before, without=motors)
    idle = {n: v for n, v in own.items() if n.split(".")[0] in ("effectiveness", "power", "push")}
    set_all(before, own)
    for instance in (untouched, before, after, always):
        instance.initialise()
    set_all(after, own)
    expected = rows(untouched, speeds)
    assert len(set(expected)) == len(expected)
    assert rows(before, speeds) == expected
    assert rows(after, speeds) == expected
    assert rows(always, speeds, each=lambda: set_all(always, idle)) == expected


def test_speeds_of_0_are_a_command_from_the_start_on(import_fmu):
    instance, simulation = import_fmu("quadrotor"), qc.Simulation("quadrotor", "eigen")
    for speeds in (0 * HOVER, HOVER):
        for fly in (instance, simulation):
            fly.command(speeds)
        instance.step(0.1)
        simulation.step(100)
    assert instance.row()[:3] == list(simulation.state.position)
    assert instance.row()[-4:] == list(simulation.state.rotor_velocity)


def test_a_start_is_what_the_topic_holds_before_anybody_publishes(import_fmu, tmp_path):
    """And what a flight is like whose caller publishes just that."""
    path = with_all_that_listens(tmp_path)
    unsaid, said = (qc.Simulation(path, "eigen") for _ in range(2))
    topics = [t for t in unsaid.topics.values() if t.writer is None]
    declared = starts(import_fmu("lab"))
    for topic in topics:
        prefix = "" if topic.name == "vel_cmd" else f"{topic.name}."
        held = {field: unsaid.topic(topic.name)[field] for field in topic.fields}
        assert held == {field: declared[prefix + field] for field in topic.fields}
    assert {t.name for t in topics} == {"vel_cmd", "payload", "later", "push", "fault"}
    assert (declared["payload.riding"], declared["later.riding"]) == (1.0, 0.0)
    for name in ("payload", "later", "push"):  # of the others no number says that nobody spoke
        said.publish(name, {f: unsaid.topic(name)[f] for f in said.topics[name].fields})
    for simulation in (unsaid, said):
        simulation.command(HOVER)
    assert (unsaid.run(0.1).table == said.run(0.1).table).all()


def test_a_field_that_is_set_leaves_the_others_as_they_act(import_fmu):
    instance, simulation = import_fmu("quadrotor"), qc.Simulation("quadrotor", "eigen")
    instance.set("effectiveness.s2", 0.5)
    simulation.publish("effectiveness", [1, 0.5, 1, 1])
    for fly in (instance, simulation):
        fly.command(HOVER)
    instance.step(0.1)
    simulation.step(100)
    assert instance.get("x", "y", "z") == list(simulation.state.position)


def test_what_was_said_may_be_taken_back_to_the_start(import_fmu):
    instance, simulation = import_fmu("quadrotor"), qc.Simulation("quadrotor", "eigen")
    for share, speeds in ((0.5, HOVER), (1.0, HOVER), (1.0, 0 * HOVER)):
        instance.set("effectiveness.s2", share)
        simulation.publish("effectiveness", [1, share, 1, 1])
        for fly in (instance, simulation):
            fly.command(speeds)
        instance.step(0.1)
        simulation.step(100)
    assert instance.row()[:3] == list(simulation.state.position)
    assert instance.row()[-4:] == list(simulation.state.rotor_velocity)


def test_a_start_that_is_set_later_is_said(import_fmu):
    """What was taken up in the meantime can be let go, what was let go taken up."""
    instance = import_fmu("lab")
    instance.step(0.1)
    assert instance.get("payload_carried.mass", "later_carried.mass") == [0.0, 0.1]
    instance.set("payload.riding", 1.0)
    instance.set("later.riding", 0.0)
    instance.step(0.1)
    assert instance.get("payload_carried.mass", "later_carried.mass") == [0.2, 0.0]


def test_what_was_tuned_is_not_taken_for_the_start(import_fmu):
    instance = import_fmu("lab", initialise=False)
    instance.set("payload.pickUp", 10.0)
    instance.set("payload.riding", 1.0)
    instance.initialise()
    instance.step(0.01)
    assert instance.get("payload_carried.mass") == [0.2]


def test_a_reference_of_zeros_is_one_once_the_flight_is_under_way(import_fmu):
    waiting, called = (import_fmu("piloted") for _ in range(2))
    names = [name for name in starts(called) if name.startswith("reference.")]
    assert names
    for instance in (waiting, called):
        instance.step(0.1)
    for name in names:
        called.set(name, 0.0)
    for instance in (waiting, called):
        instance.step(0.5)
    assert called.get("z")[0] > waiting.get("z")[0] + 0.05  # where nobody calls it falls


def test_saved_restored_and_reset_inputs_are_still_unsaid(import_fmu):
    instance, other = import_fmu("lab"), import_fmu("lab")
    own = starts(instance, without=("w1", "w2", "w3", "w4"))
    set_all(instance, own)
    slave = instance.slave
    state = slave.getFMUstate()
    data = slave.serializeFMUstate(state)
    expected = rows(other)
    assert rows(instance) == expected
    for saved in (state, slave.deSerializeFMUstate(data)):
        slave.setFMUstate(saved)
        instance.time = 0.0
        set_all(instance, own)
        assert rows(instance) == expected
    instance.set("push.fx", 1.0)
    instance.step()
    slave.reset()
    instance.time = 0.0
    slave.setupExperiment()
    assert instance.get(*own) == list(own.values())
    instance.initialise()
    assert rows(instance) == expected
