"""Controllers that command all seeds at once."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

import quadcore as qc
from quadcore.simulation.flight_plan import FlightPlan
from quadcore.studies.measured_flight import fly_and_measure, fly_together

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def policy(monkeypatch):
    """The policy of the example; `rows` lists the number of rows of each call."""
    monkeypatch.syspath_prepend(str(EXAMPLES / "matrix_policy"))
    from matrix_policy import Policy

    class Listing(Policy):
        def __init__(self):
            self.rows = []

        def __call__(self, t, state, reference):
            self.rows.append(len(state.position))
            return super().__call__(t, state, reference)

    return Listing()


@pytest.fixture
def network(monkeypatch, tmp_path):
    """The policy in ONNX Runtime, newly trained."""
    onnx = pytest.importorskip("onnx", reason="needs onnx, which pip has")
    pytest.importorskip("onnxruntime", reason="needs onnxruntime, which pip has")
    monkeypatch.syspath_prepend(str(EXAMPLES / "onnx_policy"))
    monkeypatch.chdir(tmp_path)
    import onnx_policy
    import train_policy

    onnx.save(train_policy.make_model(*train_policy.imitate()), onnx_policy.FILE)
    return onnx_policy.Policy()


def make_plans(policy, n=20, **options):
    base = FlightPlan.of(
        "quadrotor",
        engine="eigen",
        xacro_args={"sim_slow": 1},
        parameters={"odometry.positionNoise": 0.002, "odometry.angularVelocityNoise": 0.01},
        duration=1.0,
        log_every=10,
        controller=policy,
        reference=qc.references.hover(),
        on_reference=True,
        **options,
    )
    return [replace(base, seed=seed) for seed in range(n)]


def describe(plans):
    return [partial(lambda plan: plan, plan) for plan in plans]


def test_seeds_side_by_side_have_the_errors_of_single_flights(policy):
    plans = make_plans(policy)
    together = fly_together(describe(plans), 100)
    assert set(policy.rows) == {len(plans)}
    for described, outcome in zip(describe(plans), together):
        alone = fly_and_measure(described, 100)
        assert not outcome.failure and outcome.failure == alone.failure
        for name, value in outcome.measures.items():
            assert value == pytest.approx(alone.measures[name], rel=1e-9, abs=1e-12, nan_ok=True)
        assert outcome.updates == alone.updates


def test_seeds_of_a_network_have_the_errors_of_single_flights(network):
    plans = make_plans(network)
    together = fly_together(describe(plans), 100)
    for described, outcome in zip(describe(plans), together):
        alone = fly_and_measure(described, 100)
        assert outcome.failure == alone.failure == ""
        assert 0 < outcome.measures["max_position"] < 0.01
        for name in ("rms_position", "max_position", "final_position"):
            assert abs(outcome.measures[name] - alone.measures[name]) < 1e-12


def test_a_network_without_its_file_is_refused(network):
    Path("policy.onnx").unlink()
    with pytest.raises(qc.InputError, match=r"^policy\.onnx: there is no such file\. Run train_"):
        make_plans(network)[0].fly()


def test_evaluate_calls_the_controller_once_for_all_seeds(policy, tmp_path):
    """The first seed is drawn, and flies alone."""

    class Counting(type(policy)):
        def __call__(self, t, state, reference):
            (tmp_path / str(len(state.position))).touch()
            return super().__call__(t, state, reference)

    options = {"seeds": 9, "duration": 0.5, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(Counting(), "hover", **options)
    assert [row["failure"] for row in found.table] == [""] * 9
    assert {file.name for file in tmp_path.iterdir()} == {"1", "8"}


def test_a_single_run_has_one_row(policy):
    sim = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    log = sim.run(0.1, controller=policy, reference=qc.references.hover())
    assert set(policy.rows) == {1}
    assert len(log.time) == 101


def test_a_wrong_shape_fails_the_flight(policy):
    class Wrong(type(policy)):
        def __call__(self, t, state, reference):
            return super().__call__(t, state, reference)[0]

    found = qc.evaluate(Wrong(), "hover", seeds=3, duration=0.5, xacro_args={"sim_slow": 1})
    for row in found.table:
        assert "returned the shape (4,). Return (1, 4), a row for each vehicle." in row["failure"]


@pytest.mark.parametrize("error", [ValueError, SystemExit])
def test_seeds_fly_alone_if_the_controller_fails_for_several_vehicles(policy, error):
    class Single(type(policy)):
        def __call__(self, t, state, reference):
            if len(state.position) > 1:
                raise error("only in a group")
            return super().__call__(t, state, reference)

    options = {"seeds": 3, "duration": 0.5, "xacro_args": {"sim_slow": 1}}
    found = qc.evaluate(Single(), "hover", **options)
    assert [row["failure"] for row in found.table] == [""] * 3


def test_the_attribute_is_a_bool(policy):
    policy.vectorized = "yes"
    sim = qc.Simulation("quadrotor", engine="eigen")
    with pytest.raises(qc.InputError, match=r"its vectorized is 'yes'\. Give True or False\."):
        sim.run(0.1, controller=policy, reference=qc.references.hover())
