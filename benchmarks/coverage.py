"""Count how often the intervals of `quadcore evaluate` contain the true mean.

Four controllers track the circle with noise on the measured position, 400 flights each. These
flights are the population, so that its mean is known. From 2 to 20 seeds are drawn again and again,
and their intervals should contain that mean in 95 % of the cases: for the mean of each controller,
and for the difference from the first controller, paired by seed.
"""

import sys

import numpy as np

import quadcore as qc
from quadcore.studies.evaluate.intervals import compute_interval

CONTROLLERS = ["pd", "geometric", "indi", "lqr"]
NOISE = {"odometry.positionNoise": 0.0002106}  # m
FLIGHTS = 400
DRAWS = 4000  # standard error of a share: 0.35 %
LEAST, MOST = 0.93, 0.97


def count_covered(values, seeds):
    """Return the share of intervals from a number of seeds that contain the mean of all values."""
    draws = np.random.default_rng(seeds).integers(0, len(values), (DRAWS, seeds))
    low, high = np.array([compute_interval(values[draw]) for draw in draws]).T
    return np.mean((low <= values.mean()) & (values.mean() <= high))


def main():
    """Simulate, count, and return 1 if a share is out of range."""
    found = qc.evaluate(
        CONTROLLERS,
        "circle",
        seeds=FLIGHTS,
        duration=float(sys.argv[1]) if len(sys.argv) > 1 else 5.0,
        parameters=NOISE,
        xacro_args={"sim_slow": 1},
    )
    is_good = True
    for metric in ("rms_position", "max_position"):
        values = np.reshape([row[metric] for row in found.table], (len(CONTROLLERS), FLIGHTS))
        for what, samples in (("mean", values), ("difference", values[1:] - values[0])):
            for seeds in (2, 3, 5, 10, 20):
                shares = [count_covered(each, seeds) for each in samples]
                is_good &= LEAST <= min(shares) <= max(shares) <= MOST
                text = " ".join(f"{100 * share:5.1f}" for share in shares)
                print(f"{metric}, {what}, {seeds:2} seeds: covered {text} %")
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
