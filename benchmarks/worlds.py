"""Worlds with many obstacles: time and memory of loading, and what they cost a flight far away.

A process of its own loads 1,000 boxes and 50 meshes of about 10,000 triangles. Then one process
steps a vehicle in the empty world and in one with 1,000 boxes, in turns.
"""

import math
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import process_time, thread_time_ns

import numpy as np

STEPS = 2000
LARGEST_RATIO = 1.2
LARGEST_SECONDS, LARGEST_MEGABYTES = 2.0, 200
SIDES = 71  # of a mesh, along each of its angles


def write_ball(path, radius):
    """Write a ball as binary STL; return its number of triangles."""
    polar, around = np.meshgrid(
        np.linspace(0, math.pi, SIDES + 1), np.linspace(0, 2 * math.pi, SIDES + 1), indexing="ij"
    )
    points = radius * np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1
    )
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    lower, upper = np.stack([a, b, c], axis=-2)[:-1], np.stack([a, c, d], axis=-2)[1:]
    triangles = np.concatenate([lower.reshape(-1, 9), upper.reshape(-1, 9)])
    facets = np.zeros(
        len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", 9), ("rest", "<u2")]
    )
    facets["corners"] = triangles
    path.write_bytes(b" " * 80 + np.uint32(len(facets)).tobytes() + facets.tobytes())
    return len(facets)


def place(name, pose, geometry):
    """Return a model of one shape that stands still."""
    return (
        f'<model name="{name}"><static>1</static><pose>{pose}</pose><link name="link">'
        f'<collision name="shape"><geometry>{geometry}</geometry></collision></link></model>'
    )


def write_world(path, models):
    path.write_text(f'<sdf version="1.6"><world name="w">{"".join(models)}</world></sdf>')
    return str(path)


def load(world):
    """Print time and memory of loading a world."""
    import quadcore as qc

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = process_time()
    qc.Simulation("quadrotor", engine="gazebo11", world=world)
    seconds = process_time() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"seconds to load it                  {seconds:7.3f}   at most {LARGEST_SECONDS}")
    print(f"MB with Python, {before / 1024:.0f} before         {peak:7.1f}   ", end="")
    print(f"at most {LARGEST_MEGABYTES}")


def compare_steps(empty, boxes):
    """Print the ratio of the times of a step, far away from the boxes."""
    import quadcore as qc

    for engine in ("gazebo11", "ode", "eigen"):
        flights = [qc.Simulation("quadrotor", engine=engine, world=each) for each in (empty, boxes)]
        ratios = []
        for _ in range(101):
            times = []
            for flight in flights:
                flight.reset()
                start = thread_time_ns()
                flight.step(STEPS)
                times.append(thread_time_ns() - start)
            ratios.append(times[1] / times[0])
        ratio = f"{median(ratios):7.3f}   at most {LARGEST_RATIO}"
        print(f"{engine + ', 1,000 boxes / none':35} {ratio}")


def main():
    """Write the worlds, and measure."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ["GAZEBO_MODEL_PATH"] = name
        boxes = [
            place(f"box{i}", f"{20 + 3 * (i % 40)} {3 * (i // 40)} 1 0 0 0", "<box/>")
            for i in range(1000)
        ]
        balls = []
        for i in range(50):
            (folder / f"ball{i}").mkdir()
            count = write_ball(folder / f"ball{i}" / "ball.stl", 1 + 0.01 * i)
            uri = f"<mesh><uri>model://ball{i}/ball.stl</uri></mesh>"
            balls.append(place(f"ball{i}", f"{100 + 5 * i} 200 3 0 0 0", uri))
        print(f"1,000 boxes and {len(balls)} meshes of {count:,} triangles")
        whole = write_world(folder / "whole.world", boxes + balls)
        subprocess.run([sys.executable, __file__, whole], check=True)
        compare_steps(
            write_world(folder / "empty.world", []), write_world(folder / "boxes.world", boxes)
        )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        load(sys.argv[1])
    else:
        main()
