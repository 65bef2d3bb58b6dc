"""Environments of Gymnasium, on a Simulation and on a batch."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from processes import script

import quadcore as qc

gymnasium = pytest.importorskip("gymnasium", minversion="1.1")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import quadcore.gym as gym  # noqa: E402
from quadcore.gym.step_data import StepData  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
CALM = {"xacro_args": {"sim_slow": 1}, "parameters": {"drone_plugin.dragModel": "chapter2"}}
EVERYTHING = {"observation": list(gym.OBSERVATIONS), "reward": dict.fromkeys(gym.REWARDS, 1.0)}


@pytest.mark.parametrize("options", [{}, EVERYTHING], ids=["defaults", "everything"])
@pytest.mark.parametrize("model", ["quadrotor", "hexarotor"])
def test_the_checker_of_gymnasium_finds_nothing_to_say(model, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(gym.NAME, model=model, **CALM, **options).unwrapped)


def test_each_vehicle_of_a_vector_flies_the_bytes_of_an_environment_of_its_own():
    options = {**CALM, **EVERYTHING, "duration": 0.3, "spread": 0.5}
    options["parameters"] = {**CALM["parameters"], "odometry.positionNoise": 0.1}
    many = gymnasium.make_vec(
        gym.NAME, num_envs=3, vectorization_mode="vector_entry_point", **options
    )
    assert many.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    single = [gym.Env(**options) for _ in range(3)]
    observations, _ = many.reset(seed=7)
    for i, env in enumerate(single):
        assert np.array_equal(env.reset(seed=7 + i)[0], observations[i])
    ended, episodes = [False] * 3, 0
    actions = many.action_space
    actions.seed(1)
    for _ in range(70):
        action = actions.sample()
        found = many.step(action)
        for i, env in enumerate(single):
            expected = (env.reset()[0], 0.0, False, False) if ended[i] else env.step(action[i])
            assert np.array_equal(found[0][i], expected[0])
            assert [part[i] for part in found[1:4]] == list(expected[1:4])
            ended[i] = bool(expected[2] or expected[3])
            episodes += ended[i]
    assert episodes == 6


def test_the_same_seed_gives_the_same_episodes_and_another_gives_others():
    env = gym.Env(**CALM)

    def goals(seed):
        env.reset(seed=seed)
        first = env.goal
        env.reset()
        return [*first, *env.goal]

    assert goals(3) == goals(3)
    assert not set(goals(3)) & set(goals(4))
    assert np.abs(np.array(goals(5)) - [0, 0, 10] * 2).max() <= 1


def test_without_action_a_vehicle_hovers_where_its_rotors_have_spun_up():
    env = gym.Env(engine="gazebo11", duration=3, **CALM)
    env.reset(seed=1)
    ended = False
    while not ended:
        observation, _, terminated, ended, _ = env.step(np.zeros(4))
        assert not terminated
    assert env.simulation.time == pytest.approx(3)
    thrust = env.simulation.run(0, wrenches=True).wrenches["thrust"][0, 2]
    assert thrust == pytest.approx(9.8 * env.simulation.mass, rel=1e-6)
    assert np.array_equal(observation, env.unwrapped._episodes.observe(env._state())[0])


def test_actions_are_shares_of_the_speed_of_hovering_in_the_order_of_the_command():
    env = gym.Env("crazyflie", authority=0.2, xacro_args={"sim_slow": 10})
    action = np.array([1, -1, 0.5, 0])
    env.reset(seed=0)
    env.step(action)
    command = list(env.simulation.topic("vel_cmd").values())[-4:]
    hover = env.task.hover
    assert np.allclose(command, hover * (1 + 0.2 * action), rtol=1e-15)
    assert np.allclose(np.abs(hover), 1861.46, atol=0.01)  # no matter how slow


def situation():
    """One vehicle, turned by 90 degrees about z, and another upside down."""
    turned = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    return StepData(
        error=np.array([[1.0, 2, 2], [0, 0, 0]]),
        R_WF=np.array([turned, np.diag([1.0, -1, -1])]),
        linear_velocity=np.array([[3.0, 0, 4], [0, 0, 1]]),
        angular_velocity=np.array([[0, 0, 2.0], [0, 0, 0]]),
        rotor_velocity=np.array([[1.0, -2], [3, -4]]),
        action=np.array([[1.0, 0], [0, 0]]),
        action_before=np.array([[0.0, 0], [0, 1]]),
        lost=np.array([False, True]),
    )


@pytest.mark.parametrize(
    ("name", "first"),
    [
        ("error", [1, 2, 2]),
        ("body_error", [2, -1, 2]),
        ("rotation", [0, -1, 0, 1, 0, 0, 0, 0, 1]),
        ("up", [0, 0, 1]),
        ("velocity", [3, 0, 4]),
        ("body_velocity", [0, -3, 4]),
        ("rates", [0, 0, 2]),
        ("rotors", [1, -2]),
        ("action", [1, 0]),
    ],
)
def test_observations_are_what_their_names_say(name, first):
    assert np.allclose(gym.OBSERVATIONS[name].compute(situation())[0], first, atol=1e-15)


@pytest.mark.parametrize(
    ("name", "both"),
    [
        ("alive", [1, 1]),
        ("lost", [0, -1]),
        ("distance", [-3, 0]),
        ("near", [0.1, 1]),
        ("upright", [1, -1]),
        ("speed", [-5, -1]),
        ("turning", [-2, 0]),
        ("effort", [-0.5, 0]),
        ("haste", [-0.5, -0.5]),
    ],
)
def test_rewards_are_what_their_names_say(name, both):
    assert np.allclose(gym.REWARDS[name].compute(situation()), both, atol=1e-15)


def test_a_vehicle_out_of_reach_ends_its_episode_alone():
    envs = gym.VectorEnv(2, reach=3.0, spread=0.0, reward={"lost": 5.0}, **CALM)
    envs.reset(seed=0)
    actions = np.array([[0.0] * 4, [-1.0] * 4])  # the second falls
    for _ in range(200):
        _, rewards, terminated, truncated, _ = envs.step(actions)
        if terminated.any():
            break
    assert terminated.tolist() == [False, True] and not truncated.any()
    assert rewards.tolist() == [0, -5]
    observations, rewards, terminated, _, _ = envs.step(actions)
    assert envs.batch.time[1] == 0 and envs.batch.time[0] > 0.5
    assert not terminated.any() and not rewards.any()
    assert np.array_equal(observations[1, :3], [0, 0, 0])


def test_a_flight_that_fails_tells_why_and_gives_the_observation_before():
    options = {**CALM, "dt": 0.2, "rate": 5, "reach": 1e8, "spread": 0.0, "duration": 1e6}
    options["parameters"] = {"drone_plugin.dragModel": "appendix"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", qc.QuadcoreWarning)
        env = gym.Env(**options)
        envs = gym.VectorEnv(2, **options)
        env.reset(seed=0)
        envs.reset(seed=0)
        action, terminated = np.array([1.0, -1, 0.3, -0.2]), False
        for _ in range(3000):
            before = env._state()
            _, _, terminated, _, info = env.step(action)
            _, _, of_all, _, infos = envs.step(np.array([action, np.zeros(4)]))
            if terminated:
                break
    assert terminated and "the flight failed at t = " in info["failure"]
    assert np.isfinite(before.position).all()
    assert of_all[0] and infos["failure"][0] == info["failure"] and infos["_failure"][0]
    with pytest.raises(qc.InputError, match="the episode has ended"):
        env.step(action)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"observation": ["eror"]}, r"observation 'eror' does not exist\. Did you mean 'error'\?"),
        ({"observation": "error"}, "observation is 'error'. Name some of error, body_error"),
        ({"reward": {"closeness": 1}}, "reward 'closeness' does not exist"),
        ({"rate": 300}, "rate is 300: an action lasts 3.33333 steps of 0.001 s"),
        ({"authority": 1.5}, r"authority is 1.5. Give a number in \(0, 1\]"),
        ({"spread": 3.0}, "an episode could end at its start"),
        ({"duration": 0}, "duration is 0. Give a number > 0"),
        ({"seed": 1}, r"seed is an argument of reset\(\)"),
    ],
)
@pytest.mark.parametrize("kind", ["Env", "VectorEnv"])
def test_wrong_rules_are_reported(kind, options, says):
    with pytest.raises(qc.InputError, match=says):
        getattr(gym, kind)(**CALM, **options)


@pytest.mark.parametrize("make", [gym.Env, lambda **options: gym.VectorEnv(2, **options)])
def test_wrong_actions_and_options_are_reported(make):
    env = make(**CALM)
    zero = np.zeros(env.action_space.shape)
    with pytest.raises(qc.InputError, match="Reset the environment"):
        env.step(zero)
    with pytest.raises(qc.InputError, match="unknown option 'wind'"):
        env.reset(options={"wind": 1})
    env.reset(seed=0)
    with pytest.raises(qc.InputError, match=r"ha(s|ve) shape \((2, )?3,?\)\. Give shape \("):
        env.step(zero[..., 1:])
    for wrong in (zero + 1.01, zero + np.nan):
        with pytest.raises(qc.InputError, match="Clip it"):
            env.step(wrong)


def test_without_gymnasium_the_package_to_install_is_named():
    hidden = "import sys; sys.modules['gymnasium'] = None; import quadcore.gym"
    says = "quadcore.gym requires the package gymnasium, 1.1 or newer. Install it: pip install"
    assert says in script(hidden).stderr.splitlines()[-1]


def test_the_page_has_the_tables_that_hold():
    page = (ROOT / "docs" / "gym.md").read_text()
    for table in (gym.OBSERVATIONS, gym.REWARDS):
        for name, entry in table.items():
            assert f"\n| `{name}` | {entry.meaning} |\n" in page


def test_the_example_learns_to_hover(monkeypatch):
    pytest.importorskip("cma")
    monkeypatch.syspath_prepend(str(ROOT / "examples" / "hover_policy"))
    from hover_policy import measure_distances, train

    untrained = measure_distances(np.zeros((4, 12)), vehicles=20)
    away = measure_distances(train(generations=60), vehicles=20)
    assert np.isinf(away).sum() <= 2
    assert np.median(away) < 0.5 * np.median(untrained)
    sys.modules.pop("hover_policy")
