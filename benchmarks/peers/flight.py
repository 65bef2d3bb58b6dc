"""What every simulator flies, and how its flight is judged. Needs the standard library alone.

A quadrotor without drag, because that is what all of them model: a rigid body, thrust and opposing
torque with the square of the rotors' speeds, which follow their commands with a lag of first order,
and, where a simulator has it, what turning rotors do to the frame. It begins in the air, level and
at rest, its rotors still, rises, and pitches forward and back.
"""

import json
import sys
from math import dist
from time import process_time

DURATION = 5.0  # s
DOUBLET = ((1.0, 1.2, 0.98, 1.02), (1.2, 1.4, 1.02, 0.98))  # from, to (s), share of rotors 1 and 3
CLIMB = 1.02  # share of the speeds of hover


def commands(hover):
    """Pairs of a time (s) and the rotors' speeds (rad/s, unsigned) from then on."""
    base = CLIMB * hover
    rows = [(0.0, [base] * 4)]
    rows += [(begin, [a * base, base, b * base, base]) for begin, _, a, b in DOUBLET]
    return [*rows, (DOUBLET[-1][1], [base] * 4)]


def phases(hover, dt):
    """Pairs of rotor speeds (rad/s, unsigned) and for how many steps they hold."""
    rows = commands(hover)
    ends = [time for time, _ in rows[1:]] + [DURATION]
    return [(speeds, round((end - begin) / dt)) for (begin, speeds), end in zip(rows, ends)]


def vehicle():
    """The numbers of the vehicle, as `run.py` hands them to each program."""
    return json.loads(sys.argv[1])


def judge(way, dt, vehicles, fly, repeats=3):
    """Print how fast and how far off a flight is.

    Parameters
    ----------
    way : str
        What the program does: its integrator, precision, where its forces are.
    fly : callable
        Makes the whole flight; returns where the centre of mass is (m) at its end.
    """
    fly()  # compiles, warms up
    time, position = measure(fly, repeats)
    tell(way, dt, vehicles, DURATION / time, dist(position, vehicle()["end"]))


def measure(fly, repeats):
    """Return the least processor time of several calls, s, and the last result."""
    times = []
    for _ in range(repeats):
        start = process_time()  # of all threads
        result = fly()
        times.append(process_time() - start)
    return min(times), result


def tell(way, dt, vehicles, speed, error):
    """Print a row: simulated seconds of each vehicle per second, and an error in m."""
    row = {
        "way": way,
        "dt": dt,
        "vehicles": vehicles,
        "rate": vehicles * speed / dt,
        "error": error,
    }
    print(json.dumps(row), flush=True)
