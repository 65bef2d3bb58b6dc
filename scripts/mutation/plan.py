"""What is mutated, what is built of it, and which tests should notice."""

from __future__ import annotations

from typing import List, NamedTuple


class Part(NamedTuple):
    """Sources of one target, and the tests to try on their mutants, likely killers first."""

    name: str
    target: str
    library: str
    """What the target builds, beside the core."""
    sources: List[str]
    tests: List[str]
    """Of tests/python; the C++ tests come before them."""


def _core(name: str, sources: List[str], tests: List[str]) -> Part:
    return Part(name, "quadcore", "libquadcore.so", sources, tests)


def _plugin(name: str, sources: List[str], tests: List[str]) -> Part:
    folder = f"cpp/plugins/{name}"
    files = [f"{folder}/{source}" for source in sources]
    return Part(name, f"{name}_plugin", f"lib{name}_plugin.so", files, tests)


PARTS = [
    _plugin(
        "aerodynamic",
        ["aerodynamic_plugin.cpp", "drag.hpp", "flapping.hpp", "rotor_disc.hpp", "thrust.hpp"],
        ["test_forces.py", "test_warnings.py", "test_simulation.py", "test_bad_models.py"],
    ),
    _plugin(
        "motorpid",
        ["motorpid_plugin.cpp"],
        ["test_motors.py", "test_warnings.py", "test_bad_models.py", "test_determinism.py"],
    ),
    _plugin(
        "odometry",
        ["odometry_plugin.cpp"],
        ["test_odometry.py", "test_bad_models.py", "test_determinism.py"],
    ),
    _core(
        "eigen",
        [f"cpp/engines/eigen/{n}.cpp" for n in ("eigen_engine", "gyrostat", "lowest_point")],
        ["test_eigen.py", "test_gyroscopics.py", "test_simulation.py", "test_bad_models.py"],
    ),
    _core(
        "ode",
        [
            f"cpp/engines/ode/{name}.cpp"
            for name in ("body_state", "gyroscopic", "ode_engine", "ode_process")
        ],
        [
            "test_gyroscopics.py",
            "test_gazebo_recordings.py",
            "test_ground_contact.py",
            "test_random_recordings.py",
            "test_motors.py",
            "test_simulation.py",
        ],
    ),
    _core(
        "contact",
        [f"cpp/engines/ode/{n}.cpp" for n in ("constraint_rows", "gazebo_step", "ground_contact")],
        [
            "test_ground_contact.py",
            "test_gazebo_recordings.py",
            "test_random_recordings.py",
            "test_determinism.py",
        ],
    ),
    _core(
        "lumping",
        [
            f"cpp/core/src/{name}.cpp"
            for name in (
                "lumping",
                "urdf_topology",
                "references",
                "model",
                "kinematics",
                "loads",
                "spatial",
            )
        ]
        + [f"cpp/engines/ode/sdf_{n}.cpp" for n in ("conversion", "lumping", "numbers")],
        ["test_bad_models.py", "test_random_recordings.py", "test_forces.py", "test_eigen.py"],
    ),
]
