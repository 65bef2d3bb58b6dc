"""Scenarios: what befalls a vehicle, from a file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from evaluations import rows

import quadcore as qc
from quadcore.cli import main
from quadcore.model import resources
from quadcore.simulation.scenario_events import KINDS
from quadcore.simulation.scenarios import Scenario

SHIPPED = sorted(resources.list_shipped("config/scenarios"))
GUIDED = ["--controller", "geometric", "--xacro", "sim_slow:=1"]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def write_scenario(text, name="storm.yaml"):
    Path(name).write_text(text)
    return name


def fly_scenario(scenario, duration=0.4, **options):
    plan = qc.FlightPlan.of(
        scenario=scenario,
        xacro_args={"sim_slow": 1, "drag_model": "chapter2"},
        engine="eigen",
        duration=duration,
        controller=qc.controllers.parse("geometric", "quadrotor"),
        reference=qc.references.parse("hover"),
        **options,
    )
    return plan.fly()


def test_a_scenario_flies_as_the_model_with_its_plugins_written_out(tmp_path):
    """Each kind of event is the row of a tag that stands in the documentation of the plugin."""
    scenario = write_scenario(
        "plugins:\n"
        "  wind: {velocity: [3, -2, 0.5]}\n"
        "  parcel: {library: payload, mass: 0.1, xyz: [0.02, -0.01, -0.1]}\n"
        "  box: {library: libpayload_plugin.so, mass: 0.05, topic: box}\n"
        "events:\n"
        "  - {at: 0.2, release: parcel}\n"
        "  - {at: 0.1, pick_up: box}\n"
        "  - {at: 0.05, gust: [1, 2, -3], lasts: 0.1}\n"
        "  - {at: 0.07, gust: [0, 1, 0], lasts: 0.2}\n"
        "  - {at: 0.1, push: [0.5, 0, -0.1], lasts: 0.05}\n"
        "  - {at: 0.3, push: [0, 0.5, 0], torque: [0, 0.01, 0], lasts: 0.03}\n"
        "  - {at: 0.1, weaken: 2, to: 0.9}\n"
        "  - {at: 0.35, cut: 3}\n"
    )

    def plugin(name, library, tags):
        return (
            f'<gazebo><plugin name="{name}" filename="lib{library}_plugin.so">'
            f"{tags}</plugin></gazebo>"
        )

    by_hand = [
        plugin(
            "wind",
            "wind",
            "<velocity>3 -2 0.5</velocity><gusts>1 2 -3 0.05 0.1 0 1 0 0.07 0.2</gusts>",
        ),
        plugin(
            "parcel",
            "payload",
            "<mass>0.1</mass><xyz>0.02 -0.01 -0.1</xyz><release>0.2</release>",
        ),
        plugin("box", "payload", "<mass>0.05</mass><topic>box</topic><pickUp>0.1</pickUp>"),
        plugin(
            "push",
            "push",
            "<pushes>0.1 0.05 0.5 0 -0.1 0 0 0  0.3 0.03 0 0.5 0 0 0.01 0</pushes>",
        ),
        plugin("fault", "fault", "<losses>0.1 2 0.9</losses><cuts>0.35 3</cuts>"),
    ]
    arguments = {"sim_slow": "1", "drag_model": "chapter2"}
    text = qc.read_model("quadrotor", arguments).document.text
    urdf = tmp_path / "laden.urdf"
    urdf.write_text(text.replace("</robot>", "".join(by_hand) + "</robot>"))
    one = fly_scenario(scenario)
    other = fly_scenario(None)
    plan = qc.FlightPlan.of(
        urdf,
        engine="eigen",
        duration=0.4,
        controller=qc.controllers.parse("geometric", "quadrotor"),
        reference=qc.references.parse("hover"),
    )
    same = plan.fly()
    assert one.position.tobytes() == same.position.tobytes()
    assert one.rotor_velocity.tobytes() == same.rotor_velocity.tobytes()
    assert not np.array_equal(one.position, other.position)


def test_a_scenario_that_names_a_plugin_of_the_model_gives_its_tags():
    scenario = write_scenario(
        "plugins: {drone_plugin: {dragModel: chapter2, parasiticDragCoeff: 0.5}}"
    )
    plan = qc.FlightPlan.of(scenario=scenario, parameters={"drone_plugin.dragModel": "appendix"})
    of = {p.name: p.value for p in plan.simulation().plugins[0].parameters}
    assert of["parasiticDragCoeff"] == "0.5"
    assert of["dragModel"] == "appendix"  # what is set besides wins


def test_events_are_listed_by_time():
    scenario = Scenario(
        write_scenario("events:\n  - {at: 3, cut: 1}\n  - {at: 1.5, weaken: 2, to: 0.5}\n")
    )
    assert [(event.time, event.text) for event in scenario.events] == [
        (1.5, "rotor 2 to 0.5"),
        (3, "rotor 1 cut"),
    ]


@pytest.mark.parametrize(
    "text, line, says",
    [
        ("plugins:\n  wnd: {velocity: [1, 0, 0]}", 2, "libwnd_plugin.so"),
        ("plugins:\n  wind:\n    velocity: [1, 0, 0]\n    gustz: [1]", 4, "gustz"),
        ("plugins:\n  odometry:\n    positionNois: 1", 3, "positionNois"),
        ("plugins:\n  odometry: {positionNoise: -1}", 2, "positionNoise"),
        ("plugins:\n  payload:\n    mass: -1", 3, "mass"),
        ("plugins:\n  payload: {mass: [1, 2]}", 2, "mass"),
        ("events:\n  - {at: -1, cut: 1}", 2, "before the start"),
        ("events:\n  - {at: 1, cut: 1}\n  - {at: 2, cut: 1}\n  - {at: 1, cut: 1}", 4, "second"),
        ("events:\n  - {at: 1, cut: 1}\n  - {at: 1.0, weaken: 1, to: 0.5}", 3, "rotor 1"),
        ("events:\n  - {at: 1, gust: [1, 0, 0], lasts: 1}\n  - {at: 1, gust: [2, 0, 0], lasts: 1}",
         3, "'wind'"),
        ("plugins: {payload: {mass: 1}}\n"
         "events:\n  - {at: 1, release: payload}\n  - {at: 1, pick_up: payload}", 4, "'payload'"),
        ("plugins: {payload: {mass: 1}}\n"
         "events:\n  - {at: 1, release: payload}\n  - {at: 2, release: payload}", 4, "twice"),
        ("events:\n  - {at: 1, release: parcel}", 2, "mass"),
        ("events:\n  - {at: 1, cut: 1}\n  - {at: 1, cut: 5}", 3, "rotor 5 does not exist"),
        ("events:\n  - {at: 1, cut: 1.5}", 2, "rotor 1.5 does not exist"),
        ("events:\n  - {at: 1, cut: 0}", 2, "rotor 0 does not exist"),
        ("events:\n  - {at: 1, weaken: 1, to: 1.5}", 2, "remaining fraction"),
        ("events:\n  - {at: 1, gust: [1, 0, 0]}", 2, "lacks 'lasts'"),
        ("events:\n  - {at: 1, gust: [1, 0], lasts: 1}", 2, "3 numbers"),
        ("events:\n  - {at: soon, cut: 1}", 2, "a number"),
        ("events:\n  - {at: 1, explode: 1}", 2, "'explode'"),
        ("events:\n  - {at: 1, cut: 1, lats: 2}", 2, "'lats'"),
        ("events:\n  - {cut: 1}", 2, "'at'"),
        ("events: {at: 1, cut: 1}", 1, "list"),
        ("obstacles:\n  - {box: [1, 1, 0], at: [0, 0, 0]}", 2, "not positive"),
        ("obstacles:\n  - {at: [0, 0, 0]}", 2, "one shape"),
        ("obstacles:\n  - {sphere: 1}", 2, "lacks 'at'"),
        ("obstacles:\n  - {sphere: 1, at: [0, 0]}", 2, "3 numbers"),
        ("obstacles:\n  - {sphere: 1, at: [0, 0, 0], size: 2}", 2, "'size'"),
        ("obstacles:\n  - {sphere: 1, at: [9, 0, 0], name: a}\n"
         "  - {sphere: 1, at: [5, 0, 0], name: a}", 3, "second obstacle 'a'"),
        ("obstacles: {sphere: 1}", 1, "list"),
        ("weather: bad", 1, "'weather'"),
        ("- wind", 1, "plugins:"),
        ("", 1, "plugins:"),
        ("plugins: [", 2, ""),
    ],
)  # fmt: skip
@pytest.mark.parametrize("command", ["run", "evaluate"])
def test_a_bad_scenario_is_reported_in_one_line_with_file_and_line(
    command, text, line, says, capsys
):
    name = write_scenario(text + "\n")
    if command == "run":
        status = main(["run", "quadrotor", "--scenario", name, "--log", "log.csv", "--quiet"])
    else:
        guided = ["--controller", "geometric", "--reference", "hover"]
        status = main(["evaluate", *guided, "--scenario", f"none,{name}", "--out", "out"])
    messages = capsys.readouterr().err.strip()
    assert status == 2
    assert messages.startswith(f"error: storm.yaml:{line}: "), messages
    assert says in messages
    assert "\n" not in messages
    assert not Path("log.csv").exists()
    assert not Path("out/table.csv").exists()


@pytest.mark.parametrize("command", ["run", "evaluate"])
def test_events_after_the_end_are_warned_of_in_one_line(command, capsys):
    events = ["{at: 0.1, cut: 1}", "{at: 0.5, cut: 2}", "{at: 3, weaken: 3, to: 0.5}"]
    name = write_scenario("events:\n" + "".join(f"  - {event}\n" for event in events))
    given = ["--duration", "0.5", "--scenario", name, "--engine", "eigen", *GUIDED, "--quiet"]
    if command == "run":
        given = ["quadrotor", *given]
    else:
        given += ["--reference", "hover", "--seeds", "2", "--out", "out", "--no-plots"]
    assert main([command, *given]) == 0
    messages = [line for line in capsys.readouterr().err.splitlines() if "warning: storm" in line]
    assert messages == [
        "warning: storm.yaml:3: the flight ends at 0.5 s, before rotor 2 cut at 0.5 s, "
        "rotor 3 to 0.5 at 3 s"
    ]


def test_a_missing_scenario_is_reported_with_the_built_in_ones(capsys):
    assert main(["run", "quadrotor", "--scenario", "calm.yaml"]) == 2
    messages = capsys.readouterr().err
    assert all(name in messages for name in ["none", *SHIPPED])


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scenarios_fly_in_every_engine(name):
    for engine in ("gazebo11", "ode", "eigen"):
        command = ["run", "quadrotor", "--scenario", name, "--engine", engine, *GUIDED]
        assert main([*command, "--duration", "0.5", "--quiet"]) == 0


@pytest.mark.parametrize("engine", ["gazebo11", "eigen"])
def test_a_hexarotor_with_motors_of_first_order_flies_through_everything(engine):
    command = ["evaluate", "--model", "hexarotor", "--engine", engine, "--world", "default"]
    command += ["--xacro", "sim_slow:=1", "--xacro", "motor:=first_order", "--duration", "25"]
    command += ["--controller", "geometric", "--reference", "circle", "--scenario", "everything"]
    assert main([*command, "--out", "out", "--no-plots", "--quiet"]) == 0
    (row,) = rows()
    assert row["failure"] == "" and float(row["max_position"]) < 0.5


def test_the_mathematical_model_refuses_what_it_cannot_feel(capsys):
    for text, name in (
        ("plugins: {wind: {velocity: [1, 0, 0]}}", "wind"),
        ("plugins: {payload: {mass: 0.1}}", "payload"),
        ("events: [{at: 1, cut: 1}]", "fault"),
    ):
        scenario = write_scenario(text)
        command = ["run", "quadrotor", "--scenario", scenario, "--engine", "lagrange"]
        assert main([*command, *GUIDED, "--duration", "0.1"]) == 2
        assert f"plugin '{name}'" in capsys.readouterr().err


def test_a_comparison_flies_in_a_scenario_or_in_several():
    scenario = write_scenario("plugins: {wind: {velocity: [3, 0, 0]}}")
    chapter2 = {"drone_plugin.dragModel": "chapter2"}
    options = {"parameters": chapter2, "engine": "eigen", "duration": 0.3}
    table = qc.compare("quadrotor", {"scenario": ["none", scenario]}, **options).table
    assert list(table["scenario"]) == ["none", "storm.yaml"]
    assert list(table["failure"]) == ["", ""]
    assert table["max_position"][1] > 1e-6
    varied = qc.compare("quadrotor", {"wind.velocity": ["0 0 0"]}, scenario=scenario, **options)
    assert list(varied.table["failure"]) == [""]


def test_an_evaluation_has_scenarios_for_an_axis_and_reports_each_controllers_loss():
    write_scenario(
        "events: [{at: 0.2, push: [3, 0, 0], lasts: 0.1}, {at: 0.5, weaken: 1, to: 0.9}]"
    )
    command = ["evaluate", "--controller", "pid,geometric", "--reference", "hover"]
    command += ["--xacro", "sim_slow:=1", "--duration", "1", "--seeds", "2"]
    command += ["--scenario", "none,storm.yaml", "--quiet"]
    assert main([*command, "--out", "out"]) == 0
    found = rows()
    assert [row["scenario"] for row in found] == ["none", "none", "storm.yaml", "storm.yaml"] * 2
    losses = json.loads(Path("out/evaluation.json").read_text())["losses"]
    assert [(row["controller"], row["scenario"]) for row in losses] == [
        (controller, scenario)
        for controller in ("pid", "geometric")
        for scenario in ("none", "storm.yaml")
    ]
    for calm, pushed in (losses[:2], losses[2:]):
        assert (calm["loss"], calm["factor"]) in ((0, 1), (0, None))
        assert pushed["loss"] == pytest.approx(pushed["rms_position"] - calm["rms_position"])
        assert pushed["loss"] > 1e-3
    page = Path("out/report.html").read_text()
    assert "Effect of each scenario" in page


def test_pictures_over_time_have_a_mark_where_something_happens():
    import matplotlib.pyplot as plt

    from quadcore.studies.evaluate.event_marks import mark_events

    events = Scenario(
        write_scenario(
            "events: [{at: 0.2, cut: 1}, {at: 0.2, weaken: 2, to: 0.5}, {at: 3, cut: 3}]"
        )
    ).events
    figure, axes = plt.subplots()
    axes.plot([0, 1], [0, 1])
    mark_events(figure, events)
    messages = [(text.get_text(), text.xy[0]) for text in axes.texts]
    assert messages == [
        ("rotor 1 cut, rotor 2 to 0.5", 0.2)
    ]  # what is after the flight is not there
    plt.close(figure)


def test_every_kind_of_event_is_documented():
    page = (Path(__file__).resolve().parents[2] / "docs" / "disturbances.md").read_text()
    for name, kind in KINDS.items():
        assert f"| `{name}` |" in page
        assert all(f"`{key}`" in page for key in kind.others)


def test_a_scenario_places_obstacles_as_a_world_has_them(capsys):
    shapes = {
        "box": ("[0.2, 2, 3]", "<size>0.2 2 3</size>"),
        "cylinder": ("[0.1, 3]", "<radius>0.1</radius><length>3</length>"),
        "sphere": ("0.4", "<radius>0.4</radius>"),
    }
    for kind, (sizes, geometry) in shapes.items():
        placed = write_scenario(
            f"obstacles:\n  - {{{kind}: {sizes}, at: [1, 0.2, 10], rpy: [0, 0, 0.3], name: it}}\n"
        )
        Path("it.world").write_text(
            '<sdf version="1.6"><world name="w"><model name="it"><static>1</static>'
            '<pose>1 0.2 10 0 0 0.3</pose><link name="l"><collision name="c">'
            f"<geometry><{kind}>{geometry}</{kind}></geometry></collision></link></model></world></sdf>"
        )
        command = ["run", "quadrotor", *GUIDED, "--reference", "ramp:time=0.1", "--duration", "1"]
        logs = []
        for options in (["--scenario", placed], ["--world", "it.world"]):
            assert main([*command, *options, "--log", "log.csv", "--json"]) == 0
            result = json.loads(capsys.readouterr().out)
            assert result["nearest_obstacle"]["obstacle"] == "it"
            assert result["clearance"] < 1e-3
            logs.append(Path("log.csv").read_text())
        assert logs[0] == logs[1]


def test_an_obstacle_of_a_scenario_takes_no_name_of_the_world():
    Path("it.world").write_text(
        '<sdf version="1.6"><world name="w"><model name="obstacle 1"/></world></sdf>'
    )
    placed = write_scenario("obstacles:\n  - {sphere: 1, at: [9, 0, 0]}\n")
    with pytest.raises(qc.InputError, match=r"storm\.yaml:2: the world already has a model"):
        fly_scenario(placed, world="it.world")
