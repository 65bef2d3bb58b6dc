"""Place on Earth of the origin of the world, for the receivers of autopilots."""

from __future__ import annotations

import math
from typing import NamedTuple, Tuple

import numpy as np

from .._core import InputError

_YEAR = 2026.0  # of the World Magnetic Model
_METRES_PER_DEGREE = 111319.49  # at the equator, 2 pi 6378137 m / 360


class Location(NamedTuple):
    """Place on Earth of the world's origin."""

    latitude: float = 47.3977
    """deg"""
    longitude: float = 8.5456
    """deg"""
    altitude: float = 488.0
    """m above the sea"""

    def locate(self, east: float, north: float, up: float) -> Tuple[float, float, float]:
        """Return latitude (deg), longitude (deg) and altitude (m) of a point on the flat Earth.

        Parameters
        ----------
        east, north, up
            Position of the point in the world, m.
        """
        per_east = 1 / (_METRES_PER_DEGREE * math.cos(math.radians(self.latitude)))
        return (
            self.latitude + north / _METRES_PER_DEGREE,
            self.longitude + east * per_east,
            self.altitude + up,
        )


def find_magnetic_field(location: Location) -> np.ndarray:
    """Return the magnetic field of the World Magnetic Model (NOAA, 2025 to 2030) at a location.

    Returns
    -------
    ndarray (3,)
        Field in axes east, north, up, T.

    Raises
    ------
    InputError
        If pygeomag is not installed.
    """
    try:
        from pygeomag import GeoMag
    except ImportError:
        raise InputError(
            "The magnetic field of the Earth needs the package pygeomag. Install it: "
            "pip install 'quadcore[px4]'."
        ) from None
    at = GeoMag().calculate(
        glat=location.latitude, glon=location.longitude, alt=location.altitude / 1000, time=_YEAR
    )
    return np.array([at.y, at.x, -at.z]) * 1e-9
