"""The mutated sources, their targets, and the tests that should detect mutants."""

from __future__ import annotations

from typing import List, NamedTuple, Sequence


class Part(NamedTuple):
    """Sources of one target, and the tests for their mutants, most effective first."""

    name: str
    target: str
    library: str
    """File that the target builds, in the folder of the core."""
    sources: List[str]
    tests: List[str]
    """Files in tests/python; the C++ tests run first."""


def _core(name: str, sources: List[str], tests: List[str]) -> Part:
    return Part(name, "quadcore", "libquadcore.so", sources, tests)


def _headers(*names: str) -> List[str]:
    return [f"cpp/physics/{name}.hpp" for name in names]


def _plugin(name: str, sources: List[str], tests: List[str], laws: Sequence[str] = ()) -> Part:
    folder = f"cpp/plugins/{name}"
    files = [f"{folder}/{source}" for source in sources] + _headers(*laws)
    return Part(name, f"{name}_plugin", f"lib{name}_plugin.so", files, tests)


PARTS = [
    _plugin(
        "aerodynamic",
        [
            "aerodynamic_plugin.cpp",
            "configuration.hpp",
            "effectiveness.hpp",
            "law_tags.hpp",
            "shown_motion.hpp",
            "rotor_forces_lanes.cpp",
        ],
        ["test_forces.py", "test_warnings.py", "test_simulation.py", "test_bad_documents.py"],
        laws=(
            "laws/drag",
            "laws/flapping",
            "laws/law_list",
            "laws/rotor_disc",
            "laws/rotor_forces",
            "laws/thrust",
            "lanes/turn",
        ),
    ),
    _plugin(
        "motorpid",
        ["motorpid_plugin.cpp", "motor_torques.hpp", "motor_torques_lanes.cpp"],
        ["test_motors.py", "test_warnings.py", "test_bad_documents.py", "test_determinism.py"],
        laws=("laws/motor_torque",),
    ),
    _plugin(
        "odometry",
        ["odometry_plugin.cpp"],
        ["test_odometry.py", "test_bad_documents.py", "test_determinism.py"],
    ),
    _core(
        "eigen",
        [
            f"cpp/engines/eigen/{name}"
            for name in (
                "compliant_ground.cpp",
                "contact_stiffness.cpp",
                "eigen_engine.cpp",
                "gyrostat.cpp",
                "gyrostat_motion.hpp",
                "gyrostat_step.hpp",
                "gyrostat_step_lanes.cpp",
                "touching_points.cpp",
            )
        ]
        + ["cpp/core/src/vehicle/lowest_point.cpp"]
        + _headers("lanes/four", "laws/contact", "laws/gyrostat", "laws/rotors", "lanes/vec3"),
        [
            "test_eigen.py",
            "test_ground_contact.py",
            "test_gyroscopics.py",
            "test_simulation.py",
            "test_bad_documents.py",
        ],
    ),
    _core(
        "ode",
        [
            f"cpp/engines/ode/{name}.cpp"
            for name in ("body_state", "gyroscopic", "ode_engine", "ode_process", "ode_vehicle")
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
                "read/lumping",
                "read/urdf_topology",
                "read/references",
                "vehicle/model",
                "vehicle/kinematics",
                "vehicle/loads",
                "numeric/spatial",
            )
        ]
        + [f"cpp/engines/ode/sdf_{n}.cpp" for n in ("conversion", "lumping", "numbers")],
        [
            "test_bad_documents.py",
            "test_random_recordings.py",
            "test_models_for_gazebo.py",
            "test_forces.py",
            "test_eigen.py",
        ],
    ),
]
