"""Check of an autopilot on a bench: signs of sensors, order and spin of motors."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Mapping, Sequence, Tuple

import numpy as np

from .autopilot import Autopilot
from .bench import Bench, Questions
from .rotor_map import Channel, describe_quadrant, find_spin

_AXES = ("forward axis (roll)", "left axis (pitch)", "up axis (yaw)")
_TILT, _TURN = math.radians(20), 0.1  # rad, s
_NUDGE, _NUDGED = math.radians(6), 0.06  # rad, s; for an armed vehicle
_SETTLE = 2.0  # s; until the accelerometer determines the attitude
_TEST_OUTPUT = 0.2
_SEEN = 0.3  # fraction of an angle; smaller changes count as zero


def check_autopilot(autopilot: Autopilot, simulation: Any) -> List[str]:
    """Check an autopilot, and list the problems.

    The vehicle is held on a bench. It is tilted quickly, and the autopilot reports its attitude,
    which at this time depends on the gyroscopes. After some seconds at rest, the attitude depends
    on the accelerometers. Then each motor runs alone. Finally the autopilot is armed and the
    vehicle is nudged about each axis; the motors must oppose the rotation.

    Parameters
    ----------
    autopilot : Autopilot
        Autopilot that supports the method `ask`.
    simulation : Simulation
        Simulation of the vehicle, which does not move.

    Returns
    -------
    list of str
        Problems, one sentence each.

    Raises
    ------
    QuadcoreError
        If the vehicle does not match, or the autopilot does not start, answer or arm.
    """
    try:
        autopilot.prepare(simulation)
        autopilot.start(simulation.vehicle)
        bench = Bench(autopilot, -float(simulation.gravity[2]))
        bench.hold(autopilot.hold)
        questions = autopilot.ask(bench.tick)
        try:
            found = _check_sensors(bench, questions)
            problems = [*found.values(), *_check_each_motor(bench, questions, autopilot.channels)]
        finally:
            questions.close()
        if "level" not in found:
            problems += _check_responses(bench, autopilot, {axis for axis, _ in found.items()})
        return problems
    finally:
        autopilot.close()


def _check_sensors(bench: Bench, questions: Questions) -> Dict[Any, str]:
    """Return the problems of the sensors; the key of a gyroscope problem is the axis number."""
    level = questions.read_attitude()
    if max(map(abs, level[:2])) > _TILT / 2:
        return _describe_overturned(level)
    found: Dict[Any, str] = {}
    for axis in range(3):
        before = questions.read_attitude()[axis]
        bench.turn(axis, _TILT, _TURN)
        change = _wrap(questions.read_attitude()[axis] - before) / _TILT
        if change < _SEEN:
            what = "has the wrong sign" if change < -_SEEN else "is not read"
            found[axis] = f"The gyroscope about the {_AXES[axis]} {what}."
        if axis < 2:
            bench.hold(_SETTLE)
            attitude = questions.read_attitude()
            if max(map(abs, attitude[:2])) > math.pi / 2:
                return _describe_overturned(attitude)
            settled = _wrap(attitude[axis] - before) / _TILT
            if settled < _SEEN:  # roll moves gravity to the left axis, pitch to the forward axis
                what = "has the wrong sign" if settled < -_SEEN else "is not read"
                found[f"acceleration {axis}"] = (
                    f"The accelerometer along the {('left', 'forward')[axis]} axis {what}."
                )
        bench.turn(axis, -_TILT, _TURN)
        bench.hold(_SETTLE)
    return found


def _check_each_motor(bench: Bench, questions: Questions, channels: Sequence[Channel]) -> List[str]:
    problems = []
    for channel in channels:
        wanted = [_TEST_OUTPUT * (each is channel) for each in channels]
        questions.set_motors(wanted)
        bench.hold(0.05)
        if np.max(np.abs(bench.outputs - wanted)) > _TEST_OUTPUT / 2:
            given = ", ".join(f"{output:.2f}" for output in bench.outputs)
            problems.append(
                f"Motor {channel.number} was to turn alone, but the outputs were {given}."
            )
    questions.set_motors([0.0] * len(channels))
    bench.hold(0.05)
    return problems


def _check_responses(bench: Bench, autopilot: Autopilot, known: Any) -> List[str]:
    """Return the problems with the order and the spin of the motors.

    `known` contains the axes with gyroscopes that are known to be wrong.
    """
    bench.sticks = bench.sticks._replace(is_armed=True)
    bench.hold(1.0)
    bench.sticks = bench.sticks._replace(throttle=0.5)
    bench.hold(1.0)
    channels = autopilot.channels
    wanted = {channel.number: _find_response(channel.rotor) for channel in channels}
    seen: Dict[int, List[int]] = {channel.number: [0, 0, 0] for channel in channels}
    for axis in range(3):
        before = bench.outputs
        during = np.mean(bench.turn(axis, _NUDGE, _NUDGED)[-20:], axis=0)
        bench.turn(axis, -_NUDGE, _NUDGED)
        bench.hold(0.5)
        change = during - before
        change -= np.mean(change)
        sign = -1 if axis in known else 1
        for channel, each in zip(channels, change):
            small = np.max(np.abs(change)) * _SEEN
            seen[channel.number][axis] = 0 if abs(each) <= small else sign * int(np.sign(each))
    if all(seen[i][2] == -wanted[i][2] for i in wanted) and all(
        seen[i][:2] == list(wanted[i][:2]) for i in wanted
    ):
        return [
            "All motors respond to yaw with the wrong sign: the rotors of the model spin the other "
            "way. Set the autopilot's parameter (Betaflight: yaw_motors_reversed), or change the "
            "model."
        ]
    return _describe_swaps(channels, seen, wanted)


def _describe_swaps(
    channels: Sequence[Channel], seen: Dict[int, List[int]], wanted: Mapping[int, Tuple[int, ...]]
) -> List[str]:
    problems, done = [], set()
    for channel in channels:
        i = channel.number
        if tuple(seen[i]) == wanted[i] or i in done:
            continue
        others = [j for j in wanted if tuple(seen[i]) == wanted[j]]
        if others and tuple(seen[others[0]]) == wanted[i]:
            done.add(others[0])
            problems.append(
                f"Motors {i} and {others[0]} are swapped: output {i} must drive rotor "
                f"'{channels[others[0] - 1].rotor.joint}', and output {others[0]} "
                f"'{channel.rotor.joint}'."
            )
        elif others:
            problems.append(
                f"Output {i} drives rotor '{channel.rotor.joint}' but must drive "
                f"'{channels[others[0] - 1].rotor.joint}'."
            )
        else:
            x, y = channel.rotor.position[:2]
            problems.append(
                f"Motor {i} ({describe_quadrant(x, y)}) does not oppose rotations about "
                + " and ".join(_AXES[axis] for axis in range(3) if seen[i][axis] != wanted[i][axis])
                + "."
            )
    return problems


def _find_response(rotor: Any) -> Tuple[int, int, int]:
    """Return the sign of the change that opposes a positive rotation about each axis.

    Thrust at (x, y) has the moment (y, -x) about the forward and left axes. The reaction torque is
    opposite to the spin.
    """
    x, y = rotor.position[:2]
    return int(-np.sign(y)), int(np.sign(x)), find_spin(rotor)


def _describe_overturned(attitude: Sequence[float]) -> Dict[Any, str]:
    roll, pitch = (math.degrees(angle) for angle in attitude[:2])
    return {
        "level": "The accelerometer along the up axis has the wrong sign: the autopilot estimates "
        f"roll {roll:.0f} and pitch {pitch:.0f} degrees for a vehicle that is upright."
    }


def _wrap(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi
