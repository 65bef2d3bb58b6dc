"""Noise of the odometry: the thesis' from config/spiral.yaml, and noise also of velocities."""

from __future__ import annotations

from pathlib import Path

import yaml

_SPIRAL = Path(__file__).resolve().parents[1] / "config" / "spiral.yaml"
_XACRO = yaml.safe_load(_SPIRAL.read_text())["xacro"]

THESIS = {
    "odometry.positionNoise": _XACRO["position_noise"],
    "odometry.orientationNoise": _XACRO["orientation_noise"],
}
NOISY = {**THESIS, "odometry.linearVelocityNoise": 5e-3, "odometry.angularVelocityNoise": 5e-3}
