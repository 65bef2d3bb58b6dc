"""The closed-loop task of the simulators: the spiral of thesis eq. (6.1) for 30 s.

Each starts on the spiral with its velocity. The error is the RMS distance from the spiral after the
first five seconds, in which controllers without the reference's attitude settle.
"""

from math import cos, dist, sin, sqrt

from flight import measure, tell

DURATION, SETTLED = 30.0, 5.0  # s
RATE = 0.5  # rad/s
RADIUS, CLIMB, HEIGHT = 2.0, 1.0, 10.0  # m, m/s, m


def wave(t, order):
    """Return a derivative of the horizontal position, m/s^order."""
    size = RADIUS * RATE**order
    s, c = sin(RATE * t), cos(RATE * t)
    x, y = ((c, s), (-s, c), (-c, -s), (s, -c), (c, s))[order]
    return [size * x, size * y]


def position(t):
    """Return the position, m."""
    return [*wave(t, 0), HEIGHT + CLIMB * t]


def velocity(t):
    """Return the velocity, m/s."""
    return [*wave(t, 1), CLIMB]


def derivative(t, order):
    """Return the acceleration (2), jerk (3) or snap (4)."""
    return [*wave(t, order), 0.0]


def judge(way, dt, vehicles, fly, repeats=1):
    """Print how fast a flight is and how well it tracks; fly() returns times and positions."""
    time, rows = measure(fly, repeats)
    errors = [dist(place, position(t)) ** 2 for t, *place in rows if t >= SETTLED]
    tell(way, dt, vehicles, DURATION / time, sqrt(sum(errors) / len(errors)))
