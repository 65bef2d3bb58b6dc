"""Arguments of xacro, found from flights whose arguments are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from processes import run_command, run_refused
from test_fit import Excited, wide

import quadcore as qc

pytestmark = pytest.mark.filterwarnings("ignore::quadcore.QuadcoreWarning")

KNOWN = {"sim_slow": 1, "arm_mass": 0.01}
MASS, LENGTH = "xacro.frame_mass", "xacro.arm_length"
TRUE = {MASS: 1.07, LENGTH: 0.12, "motorpid_plugin.kp": 5e-4}
OTHER = {"propeller2.mass": 0.013}  # of one rotor alone


@pytest.fixture(scope="module")
def flown():
    """A lopsided vehicle's flight, logged at 100 Hz, and its commands."""
    own = {name: value for name, value in TRUE.items() if name != "motorpid_plugin.kp"}
    parameters = {**own, **OTHER}
    simulation = qc.Simulation(engine="eigen", xacro_args=KNOWN, parameters=parameters)
    controller = Excited()
    log = simulation.run(2.5, controller=controller, reference=wide, log_every=10)
    return log, np.array(controller.rows)


def test_arguments_of_xacro_are_found_beside_a_tag(flown):
    log, commands = flown
    begin = {"motorpid_plugin.kp": 4e-4, MASS: "0.9", **OTHER}
    found = qc.fit("quadrotor", log, list(TRUE), commands, parameters=begin, xacro_args=KNOWN)
    assert found.start == {MASS: 0.9, LENGTH: 0.1, "motorpid_plugin.kp": 4e-4}
    for name, value in TRUE.items():
        assert found.values[name] == pytest.approx(value, rel=1e-5), name
        assert 0 < found.identified.deviations[name] < 1e-5 * value
    assert found.identified.covariance.shape == (3, 3)
    arguments = {**KNOWN, "frame_mass": found.values[MASS], "arm_length": found.values[LENGTH]}
    written = qc.Simulation(found.model)
    parameters = {**OTHER, "motorpid_plugin.kp": found.values["motorpid_plugin.kp"]}
    expanded = qc.Simulation("quadrotor", xacro_args=arguments, parameters=parameters)
    assert np.array_equal(written.inertia, expanded.inertia)
    assert np.array_equal(written.center_of_mass, expanded.center_of_mass)


def test_bounds_hold_an_argument_and_one_that_does_nothing_is_named(flown):
    log, commands = flown
    free, bounds = [MASS, "xacro.position_noise"], {MASS: (0.95, 1.03)}
    given = {"sim_slow": 1, "arm_mass": 0.01, "arm_length": 0.12}
    found = qc.fit(
        "quadrotor", log, free, commands, bounds=bounds, xacro_args=given, parameters=OTHER
    )
    assert found.identified.without_effect == ["xacro.position_noise"]
    assert found.values[MASS] == pytest.approx(1.03, rel=1e-3)  # as far as it may go


def test_an_interrupted_fit_has_the_document_with_the_best_argument(flown):
    log, commands = flown

    def interrupt(done, _):
        if done == 2:
            raise KeyboardInterrupt

    options = {"xacro_args": {**KNOWN, "arm_length": 0.12}, "parameters": OTHER}
    with pytest.raises(KeyboardInterrupt) as stop:
        qc.fit("quadrotor", log, MASS, commands, progress=interrupt, **options)
    assert qc.Simulation(stop.value.model).mass == pytest.approx(1.07 + 0.04 + 0.043, rel=1e-4)


def test_the_document_has_what_was_set_besides(flown, tmp_path):
    log, commands = flown
    with_rate = tmp_path / "model.urdf"
    text = qc.read_model("quadrotor", xacro_args={**KNOWN, "arm_length": 0.12}).document.text
    with_rate.write_text(text.replace("<rate>1000.0</rate>", "<updateRate>1000.0</updateRate>"))
    assert "<updateRate>" in with_rate.read_text()
    besides = {"odometry.rate": 200, "odometry.twistFrame": "body", "motorpid_plugin.kp": 5e-4}
    found = qc.fit(with_rate, log, "frame.mass", commands, parameters={**OTHER, **besides})
    written = found.model.document.text
    assert "<updateRate>200</updateRate>" in written  # under the name that stands there
    assert "<twistFrame>body</twistFrame>" in written and "<kp>0.0005</kp>" in written


def test_the_command_writes_the_expanded_document(flown, in_empty_folder):
    log, commands = flown
    log.to_csv("log.csv")
    np.savetxt("c.csv", commands, fmt="%.17g", delimiter=",", header="t,w1,w2,w3,w4", comments="")
    words = ["fit", "quadrotor", "--log=log.csv", "--commands=c.csv", "-o", "fitted.urdf"]
    given = ["--xacro", "sim_slow:=1", "--xacro", "arm_mass:=0.01", "--xacro", "arm_length:=0.12"]
    odd = ["--set", "propeller2.mass=0.013"]
    done = run_command(*words, *given, *odd, "--free", MASS, "--xacro", "frame_mass:=0.9")
    assert done.returncode == 0, done.stderr
    assert "xacro" not in Path("fitted.urdf").read_text()
    assert qc.Simulation("fitted.urdf").mass == pytest.approx(1.07 + 0.04 + 0.043, rel=1e-4)
    Path("fitted.urdf").rename("plain.urdf")
    for model, name, expected in (
        (
            "quadrotor",
            "xacro.drag",
            "free xacro.drag: 'all' is not a number. Only numbers can be fitted.",
        ),
        ("quadrotor", "xacro.fram_mass", "has no such parameter. Did you mean 'xacro.frame_mass'?"),
        ("plain.urdf", MASS, f"free {MASS}: model quadrotor has no such parameter"),
    ):
        assert expected in run_refused("fit", model, *words[2:], "--free", name)
    assert not Path("fitted.urdf").exists()


def test_a_model_that_is_read_has_no_arguments_to_be_found(flown):
    log, commands = flown
    refusal = r"free xacro\.frame_mass: a Model has no xacro arguments\. Give the file\."
    with pytest.raises(qc.InputError, match=refusal):
        qc.fit(qc.read_model("quadrotor"), log, MASS, commands)
