"""Single evaluations of the force laws: signs, symmetries, and numbers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from flights import ENGINES
from scipy.spatial.transform import Rotation
from vehicles import (
    AIR,
    CROSS,
    DRAG,
    FLAPPING,
    HAND,
    HEIGHT,
    MOTOR,
    ODD,
    Rotor,
    start,
    upright,
    vehicle,
    wrenches,
)

import quadcore as qc

DRAGS = ("induced", "translational", "profile", "parasitic")
EVERYTHING = {**AIR, **DRAG, **FLAPPING}
CHAPTER2 = {**EVERYTHING, "dragModel": "chapter2"}
APPENDIX = {**EVERYTHING, "dragModel": "appendix"}
MIRROR = np.diag([1.0, -1.0, 1.0])  # at the x-z plane: rotor 2 becomes 4


class Motion:
    """A random motion of a quadrotor, and the same motion seen otherwise."""

    def __init__(self, seed):
        random = np.random.default_rng(seed)
        self.attitude = Rotation.from_quat(random.normal(size=4))
        self.v = random.normal(size=3) * 5
        self.w = random.normal(size=3) * 2
        self.spin = random.normal(size=4) * 400
        self.angle = random.uniform(-3, 3, size=4)

    def given_to(self, simulation):
        return start(
            simulation,
            orientation=self.attitude.as_quat(),
            linear_velocity=self.v,
            angular_velocity=self.w,
            rotor_velocity=self.spin,
            rotor_angle=self.angle,
        )

    def mirrored(self):
        other = Motion(0)
        other.attitude = Rotation.from_quat(self.attitude.as_quat() * [-1, 1, -1, 1])
        other.v = MIRROR @ self.v
        other.w = -MIRROR @ self.w
        other.spin = -self.spin[[0, 3, 2, 1]]
        other.angle = -self.angle[[0, 3, 2, 1]]
        return other

    def turned(self, turn):
        other = Motion(0)
        other.__dict__.update(self.__dict__)
        other.attitude = turn * self.attitude
        other.v = turn.apply(self.v)
        return other

    def moved_along(self, v):
        other = Motion(0)
        other.__dict__.update(self.__dict__)
        other.v = self.v + v
        return other


def same(a, b, terms=None):
    for term in terms or a:
        assert np.allclose(a[term], b[term], rtol=0, atol=1e-12), term
    return True


@pytest.mark.parametrize("rotors", [CROSS, ODD], ids=["cross", "odd"])
def test_drag_takes_power_in_still_air(hangar, rotors):
    simulation = hangar(vehicle(rotors, air=CHAPTER2))
    center = simulation.center_of_mass
    for seed in range(100):
        motion = Motion(seed)
        found = wrenches(motion.given_to(simulation))
        v_center = motion.attitude.inv().apply(motion.v) + np.cross(motion.w, center)
        for term in DRAGS:
            force, torque = found[term][:3], found[term][3:]
            assert force @ v_center + torque @ motion.w < 0, term


@pytest.mark.parametrize("term", DRAGS[:3])
def test_rotor_drag_of_the_appendix_takes_power_too(hangar, term):
    simulation = hangar(vehicle(air=APPENDIX))
    center = simulation.center_of_mass
    for seed in range(100):
        motion = Motion(seed)
        wrench = wrenches(motion.given_to(simulation))[term]
        v_center = motion.attitude.inv().apply(motion.v) + np.cross(motion.w, center)
        assert wrench[:3] @ v_center + wrench[3:] @ motion.w < 0


def test_there_is_no_drag_when_the_wind_blows_as_fast(hangar):
    wind = np.array([3.0, -4.0, 1.5])
    simulation = hangar(vehicle(ODD, air=CHAPTER2), wind=wind)
    for seed in range(20):
        motion = Motion(seed)
        motion.v, motion.w = wind, np.zeros(3)
        found = wrenches(motion.given_to(simulation))
        for term in (*DRAGS, "flapping"):
            assert np.abs(found[term]).max() < 1e-15, term
        assert np.abs(found["thrust"]).max() > 0.1


def test_only_the_velocity_through_the_air_counts_in_chapter2(hangar):
    wind = np.array([3.0, -4.0, 1.5])
    still, windy = hangar(vehicle(air=CHAPTER2)), hangar(vehicle(air=CHAPTER2), wind=wind)
    for seed in range(20):
        motion = Motion(seed)
        drifting = motion.moved_along(wind)
        assert same(wrenches(motion.given_to(still)), wrenches(drifting.given_to(windy)))


def test_the_appendix_knows_no_wind(hangar):
    still, windy = hangar(vehicle(air=APPENDIX)), hangar(vehicle(air=APPENDIX), wind=(5, 5, 5))
    for seed in range(20):
        motion = Motion(seed)
        assert same(wrenches(motion.given_to(still)), wrenches(motion.given_to(windy)))


@pytest.mark.parametrize("air", [CHAPTER2, APPENDIX], ids=["chapter2", "appendix"])
def test_a_mirrored_motion_meets_mirrored_forces(hangar, air):
    simulation = hangar(vehicle(air=air))
    for seed in range(50):
        motion = Motion(seed)
        found = wrenches(motion.given_to(simulation))
        mirrored = wrenches(motion.mirrored().given_to(simulation))
        for term, wrench in found.items():
            expected = np.concatenate([MIRROR @ wrench[:3], -MIRROR @ wrench[3:]])
            assert np.allclose(mirrored[term], expected, rtol=0, atol=1e-12), term


def test_forces_do_not_depend_on_where_the_vehicle_heads_in_the_world(hangar):
    simulation = hangar(vehicle(ODD, air=CHAPTER2))
    for seed in range(20):
        motion = Motion(seed)
        turned = motion.turned(Rotation.from_euler("z", seed))
        assert same(wrenches(motion.given_to(simulation)), wrenches(turned.given_to(simulation)))


def test_forces_of_the_appendix_do_so_by_its_parasitic_drag_alone(hangar):
    simulation = hangar(vehicle(air=APPENDIX))
    motion = Motion(1)
    found = wrenches(motion.given_to(simulation))
    turned = wrenches(motion.turned(Rotation.from_euler("z", 1)).given_to(simulation))
    assert same(found, turned, set(found) - {"parasitic"})
    assert np.abs(found["parasitic"] - turned["parasitic"]).max() > 0.01


@pytest.mark.parametrize("air", [CHAPTER2, APPENDIX], ids=["chapter2", "appendix"])
def test_forces_follow_a_vehicle_that_is_turned_about_its_own_axis(hangar, air):
    """The cross is itself after a quarter turn: rotor i then stands where i - 1 stood."""
    simulation = hangar(vehicle(air={**air, "parasiticDragCoeff": 0}))
    quarter = Rotation.from_euler("z", 90, degrees=True)
    for seed in range(20):
        motion = Motion(seed)
        found = wrenches(motion.given_to(simulation))
        turned = motion.moved_along(0)
        turned.attitude = motion.attitude * quarter.inv()
        turned.w = quarter.apply(motion.w)
        turned.spin, turned.angle = np.roll(motion.spin, -1), np.roll(motion.angle, -1)
        for term, wrench in wrenches(turned.given_to(simulation)).items():
            expected = quarter.apply(found[term].reshape(2, 3)).ravel()
            assert np.allclose(wrench, expected, rtol=0, atol=1e-12), term


@pytest.mark.parametrize("model", ["appendix", "chapter2"])
def test_thrust_lifts_whatever_way_a_rotor_turns(hangar, model):
    found = upright(hangar, {**HAND, "dragModel": model}, spin=(300, -200, 0, 0))["thrust"]
    # 0.9 N at +x and 0.4 N at -y, both 0.2 m out.
    assert np.allclose(found, [0, 0, 1.3, -0.08, -0.18, 0], rtol=0, atol=1e-15)


@pytest.mark.parametrize("model", ["appendix", "chapter2"])
@pytest.mark.parametrize(("sign", "way"), [(1, "thesis"), (-1, "opposing")])
def test_reaction_has_the_sign_of_the_spin_in_the_thesis_and_opposes_it_in_air(
    hangar, model, sign, way
):
    air = {**HAND, "dragModel": model, "reactionTorque": way}
    for spin in (300, -300):
        found = upright(hangar, air, spin=(spin, 0, 0, 0))["reaction"]
        expected = [0, 0, 0, 0, 0, sign * np.sign(spin) * 0.018]
        assert np.allclose(found, expected, rtol=0, atol=1e-16)


def test_forces_see_the_speed_before_it_was_slowed(hangar):
    fast = upright(hangar, HAND, spin=(300, -300, 200, 100))
    slowed = upright(hangar, {**HAND, "sim_slow": 10}, spin=(30, -30, 20, 10))
    assert same(fast, slowed)


def test_a_tilted_rotor_turns_the_frame_about_its_own_axis_or_about_z(hangar):
    tilted = (Rotor((0.2, 0, 0), (np.pi / 6, 0, 0)),)
    for model, axis in (("chapter2", [0, -0.5, np.sqrt(0.75)]), ("appendix", [0, 0, 1])):
        found = upright(hangar, {**HAND, "dragModel": model}, tilted, spin=(300,), engine="ode")
        assert np.allclose(found["reaction"][3:], 0.018 * np.array(axis), rtol=0, atol=1e-12)
        assert np.allclose(found["thrust"][:3], [0, -0.45, 0.9 * np.sqrt(0.75)], atol=1e-12)


@pytest.mark.parametrize("model", ["appendix", "chapter2"])
@pytest.mark.parametrize(("term", "coefficient"), list(zip(DRAGS, (0.01, 0.0025, 0.005))))
def test_rotor_drag_opposes_the_velocity_in_the_disc(hangar, model, term, coefficient):
    air = {**AIR, f"{term}DragCoeff": coefficient, "dragModel": model}
    simulation_mass, frame = 1.04, 1.0
    arm = HEIGHT * frame / simulation_mass  # of the rotors above the centre of mass
    found = upright(hangar, air, v=(2, -3, 7), engine="ode")
    force = -4 * coefficient * np.array([2, -3, 0])
    torque = np.cross([0, 0, arm], force)
    assert np.allclose(found[term], [*force, *torque], rtol=0, atol=1e-14)
    for other in set(DRAGS) - {term}:
        assert not found[other].any()
    # Yawing at 1 rad/s, each rotor moves at 0.2 m/s across its arm.
    yawing = upright(hangar, air, w=(0, 0, 1), engine="ode")[term]
    assert np.allclose(yawing, [0, 0, 0, 0, 0, -4 * coefficient * 0.2 * 0.2], rtol=0, atol=1e-15)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("model", "at_origin"), [("appendix", True), ("chapter2", False)])
def test_drag_takes_the_velocity_of_the_links_origin_or_of_its_centre_of_mass(
    hangar, engine, model, at_origin
):
    # The hub hangs 0.05 m below the blades' centre of mass; both lean by the joint's angles.
    mast = Rotor((0.2, -0.1, 0.03), (0.2, -0.1, 0.4), com=(0, 0, 0.05))
    air = {**AIR, "inducedDragCoeff": 0.01, "dragModel": model}
    w = np.array([1.5, -2, 0.7])
    simulation = start(hangar(vehicle([mast], air=air), engine=engine), angular_velocity=w)
    lean = Rotation.from_euler("xyz", mast.rpy)
    center = np.array(mast.xyz) + lean.apply(mast.com)
    v = np.cross(w, mast.xyz if at_origin else center)
    across = np.eye(3) - np.outer(lean.apply([0, 0, 1]), lean.apply([0, 0, 1]))
    force = -0.01 * across @ v
    arm = center * (1 - mast.mass / (1 + mast.mass))  # the frame weighs 1 kg and sits at 0
    expected = [*force, *np.cross(arm, force)]
    assert np.allclose(wrenches(simulation)["induced"], expected, rtol=0, atol=1e-12)


def test_parasitic_drag_acts_once_at_the_centre_of_mass_in_chapter2(hangar):
    air = {**AIR, "parasiticDragCoeff": 0.003, "dragModel": "chapter2"}
    found = upright(hangar, air, ODD, v=(2, -3, 6))["parasitic"]  # 7 m/s
    assert np.allclose(found, [-0.042, 0.063, -0.126, 0, 0, 0], rtol=0, atol=1e-12)


def test_parasitic_drag_acts_by_component_on_each_propeller_in_the_appendix(hangar):
    air = {**AIR, "parasiticDragCoeff": 0.003}
    found = upright(hangar, air, v=(2, -3, 6))["parasitic"]
    assert np.allclose(found[:3], 4 * 0.003 * np.array([-4, 9, -36]), rtol=0, atol=1e-15)
    # The components of the world are taken for those of the turned propeller.
    simulation = hangar(vehicle(air=air))
    start(simulation, linear_velocity=[2, -3, 6], rotor_angle=[np.pi / 2] * 4)
    turned = wrenches(simulation)["parasitic"]
    assert np.allclose(turned[:3], 4 * 0.003 * np.array([-9, -4, -36]), rtol=0, atol=1e-12)


def test_a_motion_without_velocity_meets_no_drag(hangar):
    for air in (CHAPTER2, APPENDIX):
        found = upright(hangar, air, ODD, spin=(400, -300, 200, 100))
        for term in (*DRAGS, "flapping"):
            assert not found[term].any()


AIRFRAME = {
    "axialDragCoeff": 0.05,
    "bodyDragXCoeff": 0.004,
    "bodyDragYCoeff": 0.005,
    "bodyDragZCoeff": 0.006,
    "hubMomentCoeff": 0.02,
    "rollDampingCoeff": 0.001,
    "pitchDampingCoeff": 0.002,
    "yawDampingCoeff": 0.003,
    "constantTorqueX": 0.01,
    "constantTorqueY": -0.02,
    "constantTorqueZ": 0.03,
}


@pytest.mark.parametrize("engine", ENGINES)
def test_the_airframe_feels_its_drag_hub_moment_damping_and_constant_torque(hangar, engine):
    simulation = hangar(vehicle(air={**AIR, **AIRFRAME, "dragModel": "chapter2"}), engine=engine)
    start(simulation, linear_velocity=[2, -3, 6], angular_velocity=[1, 2, -1])
    # The frame is level, and its centre of mass lies on its z axis, 2.5 mm above the origin.
    v = np.array([2, -3, 6]) + np.cross([1, 2, -1], [0, 0, center_of_mass(simulation)])
    force = [-0.004 * abs(v[0]) * v[0], -0.005 * abs(v[1]) * v[1], -(0.05 + 0.006 * v[2]) * v[2]]
    hub = -0.02 * np.cross([0, 0, 1], v)
    torque = hub - np.array([0.001 * 1, 0.002 * 2, 0.003 * -1]) + [0.01, -0.02, 0.03]
    found = wrenches(simulation)["parasitic"]
    assert np.allclose(found, [*force, *torque], rtol=0, atol=1e-7)  # Gazebo rounds masses


def center_of_mass(simulation):
    """The height of the centre of mass above the origin of the frame, from the masses."""
    rotors = 4 * 0.01
    return rotors * HEIGHT / simulation.mass


def test_the_airframes_drag_takes_energy_and_is_none_in_still_air_that_moves_along(
    hangar, tmp_path
):
    names = [name for name in AIRFRAME if "Torque" not in name and name != "hubMomentCoeff"]
    air = {**AIR, **{name: AIRFRAME[name] for name in names}, "dragModel": "chapter2"}
    for v, w in (((2, -3, 6), (1, 2, -1)), ((-1, 4, -2), (-3, 0.5, 2))):
        simulation = start(hangar(vehicle(air=air)), linear_velocity=v, angular_velocity=w)
        force = wrenches(simulation)["parasitic"]
        center = np.array(v) + np.cross(w, [0, 0, center_of_mass(simulation)])
        assert force[:3] @ center < 0 and force[3:] @ np.array(w) < 0


def test_factors_scale_thrust_and_reaction_of_each_rotor(hangar):
    factors = [1, 0.5, 0, 1.2]
    for engine in ENGINES:
        plain = start(hangar(vehicle(air=AIR), engine=engine), rotor_velocity=[400] * 4)
        air = {**AIR, "rotorFactors": " ".join(map(str, factors))}
        scaled = start(hangar(vehicle(air=air), engine=engine), rotor_velocity=[400] * 4)
        whole, part = wrenches(plain), wrenches(scaled)
        assert part["thrust"][2] == pytest.approx(whole["thrust"][2] * sum(factors) / 4)
        assert part["reaction"][5] == pytest.approx(whole["reaction"][5] * sum(factors) / 4)


def test_a_wrong_number_of_factors_is_refused(hangar):
    with pytest.raises(qc.InputError, match="<rotorFactors> has 3 numbers, but the plugin has 4"):
        hangar(vehicle(air={**AIR, "rotorFactors": "1 1 1"}))


@pytest.mark.parametrize("engine", ["eigen", "gazebo11"])
def test_a_batch_with_airframes_moves_like_its_simulations(hangar, tmp_path, engine):
    file = tmp_path / "m.urdf"
    file.write_text(vehicle(air={**AIR, "dragModel": "chapter2"}, motor=MOTOR))
    values = {f"aerodynamic.{name}": [0, 0.3 * v, v] for name, v in AIRFRAME.items()}
    batch = qc.BatchSimulation(
        file, n=3, engine=engine, parameters={k: np.array(v) for k, v in values.items()}
    )
    batch.step(np.tile([440.0, -430, 450, -420], (3, 1)), 200)
    for i in range(3):
        simulation = qc.Simulation(
            file, engine=engine, parameters={name: v[i] for name, v in values.items()}
        )
        simulation.command([440, -430, 450, -420])
        simulation.step(200)
        assert np.array_equal(batch.state.position[i], simulation.state.position)
        assert np.array_equal(batch.state.angular_velocity[i], simulation.state.angular_velocity)
