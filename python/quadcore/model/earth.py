"""Location of a world on Earth: gravity, magnetic field, and origin of GPS receivers."""

from __future__ import annotations

import math
from typing import NamedTuple, Sequence, Tuple

import numpy as np

from .._core import InputError, World, read_world
from ..support.optional_packages import require_package
from .world_text import change_world_text, find_children

_YEAR = 2026.0  # date for the World Magnetic Model
_METRES_PER_DEGREE = 111319.49  # at the equator, 2 pi 6378137 m / 360

# Somigliana's formula with the constants of WGS 84 (NIMA TR8350.2, equation 4-1)
_GRAVITY, _GROWTH, _ECCENTRICITY = 9.7803253359, 0.00193185265241, 0.00669437999013
_FREE_AIR = 3.086e-6  # 1/s^2; decrease of gravity with altitude

_ORIGIN = "spherical_coordinates"
_PLACE = ("latitude_deg", "longitude_deg", "elevation")


class Location(NamedTuple):
    """Location of the world's origin, where x is east and y is north."""

    latitude: float = 47.3977
    """Latitude, deg."""
    longitude: float = 8.5456
    """Longitude, deg."""
    altitude: float = 488.0
    """Altitude above sea level, m."""

    def locate(self, east: float, north: float, up: float) -> Tuple[float, float, float]:
        """Return latitude (deg), longitude (deg) and altitude (m) of a point, for a flat Earth.

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


def check_location(at: Sequence[float]) -> Location:
    """Make a location from latitude and longitude (deg), and optionally altitude (m).

    Raises
    ------
    InputError
        If the location is not on Earth.
    """
    location = Location(*(float(part) for part in (*at, 0.0)[:3]))
    if abs(location.latitude) > 90 or abs(location.longitude) > 180:
        raise InputError(
            f"at is {location.latitude:g}, {location.longitude:g}. Give a latitude from -90 to 90 "
            "and a longitude from -180 to 180 degrees."
        )
    return location


def find_gravity(location: Location) -> float:
    """Return the normal gravity of WGS 84 minus its decrease with altitude, m/s^2."""
    s = math.sin(math.radians(location.latitude)) ** 2
    return _GRAVITY * (1 + _GROWTH * s) / math.sqrt(1 - _ECCENTRICITY * s) - (
        _FREE_AIR * location.altitude
    )


def find_magnetic_field(location: Location) -> np.ndarray:
    """Return the magnetic field of the World Magnetic Model (NOAA, 2025 to 2030) in 2026.

    Returns
    -------
    ndarray (3,)
        Field in east, north, up axes, T.

    Raises
    ------
    InputError
        If pygeomag is not installed.
    """
    with require_package("The magnetic field of the Earth", "pygeomag", "px4"):
        from pygeomag import GeoMag
    at = GeoMag().calculate(
        glat=location.latitude, glon=location.longitude, alt=location.altitude / 1000, time=_YEAR
    )
    return np.array([at.y, at.x, -at.z]) * 1e-9


def find_location(world: World) -> Location:
    """Return the location in the <spherical_coordinates> of a world, or the default location."""
    from xml.etree import ElementTree  # its import takes 6 ms

    text = world.document.text
    for child in find_children(text)[0]:
        if child.name == _ORIGIN:
            element = ElementTree.fromstring(text[child.begin : child.end])
            return Location(*(float(element.findtext(name, "0")) for name in _PLACE))
    return Location()


def place_world(world: World, location: Location) -> World:
    """Return the world at a location, with the gravity and magnetic field of this location."""
    east, north, up = find_magnetic_field(location).tolist()
    origin = "".join(f"<{name}>{value!r}</{name}>" for name, value in zip(_PLACE, location))
    elements = {
        "gravity": f"<gravity>0 0 {-find_gravity(location)!r}</gravity>",
        "magnetic_field": f"<magnetic_field>{east!r} {north!r} {up!r}</magnetic_field>",
        _ORIGIN: f"<{_ORIGIN}><surface_model>EARTH_WGS84</surface_model>{origin}</{_ORIGIN}>",
    }
    added = [(element, ("--at", 1)) for element in elements.values()]
    document = change_world_text(world.document, elements, added)
    return read_world(document, list(world.ignored_elements.ignored))
