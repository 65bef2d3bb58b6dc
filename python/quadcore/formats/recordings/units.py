"""Factors from the units of logs to SI units."""

from __future__ import annotations

import math

UNITS = {
    "1": 1.0,
    "s": 1.0,
    "ms": 1e-3,
    "us": 1e-6,
    "ns": 1e-9,
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "m/s": 1.0,
    "cm/s": 1e-2,
    "mm/s": 1e-3,
    "m/s^2": 1.0,
    "g": 9.80665,
    "rad": 1.0,
    "deg": math.radians(1),
    "rad/s": 1.0,
    "deg/s": math.radians(1),
    "rpm": 2 * math.pi / 60,
    "V": 1.0,
    "cV": 1e-2,
    "mV": 1e-3,
}
"""Factor of each unit."""
