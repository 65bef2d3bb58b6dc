"""The same bytes on every x86-64 processor.

glibc picks a variant of sin, cos, log and the like by what the processor can do. Whatever feeds a
state must therefore not come from there.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from functools import lru_cache
from pathlib import Path

import pytest
from flights import ENGINES
from vehicles import AIR, DRAG, FLAPPING, MOTOR, ODD, SKEW, plugin, vehicle

import quadcore as qc

TESTS = Path(__file__).resolve().parent
LIBRARIES = sorted((Path(qc.__file__).parent / "lib").glob("lib*.so*"))
AS_AN_OLD_PROCESSOR = "glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4"

# Rotations and poses with many digits in the file and at the start; noise on all that is sensed.
NOISE = {
    "positionNoise": 0.1,
    "orientationNoise": 0.02,
    "linearVelocityNoise": 0.3,
    "angularVelocityNoise": 0.4,
}
TRANSCENDENTAL = (
    "sin|cos|sincos|tan|a(sin|cos|tan)h?|atan2|(sin|cos|tan)h|sinpi|cospi|exp(2|10|m1)?"
    "|log(2|10|1p|b)?|pow|cbrt|hypot|erfc?|[lt]gamma|j[01n]|y[01n]"
)
FLY = """
import hashlib, sys
import quadcore as qc
from flights import bits
for engine in sys.argv[4:]:
    for drag in ("appendix", "chapter2"):
        touches = sys.argv[3] == "default"
        simulation = qc.Simulation(
            sys.argv[1],
            engine=engine,
            world=sys.argv[3],
            parameters={sys.argv[2] + ".dragModel": drag},
            spawn=(1, 2, 0.3 if touches else 10, 0.3, -0.2, 1),
            seed=7,
        )
        simulation.command([71, -40, 80, -35] if touches else [471, -400, 480, -395])
        digest = hashlib.sha256()
        for _ in range(400):
            simulation.step(5)
            digest.update(bits(simulation))
        print(engine, drag, digest.hexdigest())
"""


CONTROL = """
import hashlib
import quadcore as qc
for controller in ("geometric", "lqr", "indi"):
    simulation = qc.Simulation("quadrotor", engine="eigen", xacro_args={"sim_slow": 1})
    log = simulation.run(2.0, controller=controller, reference="spiral")
    print(controller, hashlib.sha256(log.table.tobytes()).hexdigest())
"""


@lru_cache(maxsize=None)
def fly(model, world="empty", **environment):
    """Hash of every bit of state and odometry on the way, for each engine and drag model."""
    aerodynamic = "drone_plugin" if model == "quadrotor" else "aerodynamic"
    command = [sys.executable, "-c", FLY, str(model), aerodynamic, world, *ENGINES]
    environment = {**os.environ, "PYTHONPATH": str(TESTS), **environment}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def odd(tmp_path_factory):
    """File of a vehicle that is the same in no two axes, with noisy odometry."""
    urdf = vehicle(ODD, 1, SKEW, (0.01, -0.02, 0.015), {**AIR, **DRAG, **FLAPPING}, MOTOR)
    path = tmp_path_factory.mktemp("odd") / "odd.urdf"
    path.write_text(urdf.replace("</robot>", plugin("odometry", NOISE) + "</robot>"))
    return path


def test_flights_and_noise_are_the_same_with_and_without_fused_multiply_adds(odd):
    here = fly(odd)
    assert len(here) == 2 * len(ENGINES)
    assert fly(odd, GLIBC_TUNABLES=AS_AN_OLD_PROCESSOR) == here


@pytest.mark.parametrize("lanes", ["1", "2", "4", "8"])
@pytest.mark.parametrize("name", ["quadrotor", "odd"])
def test_rotors_in_lanes_of_every_width_fly_the_same_bytes(name, lanes, odd):
    model = odd if name == "odd" else name
    assert fly(model, QUADCORE_LANES=lanes) == fly(model)


def test_controllers_of_single_flights_give_the_same_bytes_in_lanes_of_every_width():
    flown = {
        subprocess.run(
            [sys.executable, "-c", CONTROL],
            env={**os.environ, "QUADCORE_LANES": lanes},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for lanes in ("1", "2", "4", "8")
    }
    assert len(flown) == 1
    assert flown.pop().count("\n") == 3


def test_what_touches_the_ground_flies_the_same_bytes_too():
    here = fly("quadrotor", "default")
    assert fly("quadrotor", "default", GLIBC_TUNABLES=AS_AN_OLD_PROCESSOR) == here
    for lanes in ("1", "2", "8"):
        assert fly("quadrotor", "default", QUADCORE_LANES=lanes) == here


def test_a_width_that_no_lanes_have_is_refused():
    with pytest.raises(subprocess.CalledProcessError) as refused:
        fly("quadrotor", QUADCORE_LANES="3")
    assert "QUADCORE_LANES is '3'. Use 1, 2, 4 or 8." in refused.value.stderr


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda library: library.name)
def test_no_library_asks_libm_for_what_it_does_not_round_exactly(library):
    listed = subprocess.run(
        ["nm", "-D", "--undefined-only", str(library)], capture_output=True, text=True, check=True
    )
    names = {line.split()[-1].split("@")[0] for line in listed.stdout.splitlines()}
    assert names
    named = re.compile(rf"(__)?({TRANSCENDENTAL})(_finite|f|l)?")
    assert not sorted(name for name in names if named.fullmatch(name))


def test_no_plugin_that_is_shown_asks_libm_for_what_it_does_not_round_exactly():
    pages = sorted((TESTS.parents[1] / "docs").rglob("*.md"))
    shown = [page.read_text() for page in pages]
    shown = [code for text in shown for code in re.findall(r"```cpp\n(.*?)```", text, re.DOTALL)]
    shown += [file.read_text() for file in sorted((TESTS.parents[1] / "examples").rglob("*.cpp"))]
    asked = re.compile(rf"std::({TRANSCENDENTAL})\(|AngleAxis")
    assert len(shown) > 10
    assert [line for code in shown for line in code.splitlines() if asked.search(line)] == []
