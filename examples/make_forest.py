"""Write a world with a forest of cylinders from a seed.

Usage: make_forest.py SEED [TREES] > forest.world
"""

from __future__ import annotations

import random
import sys

HALF_WIDTH = 20.0  # m
CLEARING = 1.5  # radius without trunks around the origin (m)
GAP = 1.2  # minimum distance of two trunks' axes (m)
HEIGHT = 14.0  # m

WORLD = """\
<?xml version="1.0"?>
<!-- Written by examples/make_forest.py {arguments}: trunks on the ground plane. -->
<sdf version="1.6">
  <world name="forest">
    <include>
      <uri>model://ground_plane</uri>
    </include>
{models}  </world>
</sdf>
"""
TREE = """\
    <model name="tree_{i}">
      <static>true</static>
      <pose>{x:.3f} {y:.3f} {z:g} 0 0 0</pose>
      <link name="link">
        <collision name="trunk">
          <geometry><cylinder><radius>{radius:.3f}</radius><length>{height:g}</length></cylinder></geometry>
        </collision>
      </link>
    </model>
"""


def place_trees(seed: int, trees: int) -> list[tuple[float, float, float]]:
    """Return x, y and radius of each trunk (m): uniform on a square, apart from one another."""
    generator = random.Random(seed)
    placed: list[tuple[float, float, float]] = []
    for _ in range(1000 * trees):
        if len(placed) == trees:
            return placed
        x, y = (generator.uniform(-HALF_WIDTH, HALF_WIDTH) for _ in range(2))
        radius = generator.uniform(0.1, 0.3)
        is_free = all((x - a) ** 2 + (y - b) ** 2 > GAP**2 for a, b, _ in placed)
        if is_free and x**2 + y**2 > (CLEARING + radius) ** 2:
            placed.append((x, y, radius))
    sys.exit(f"{trees} trees do not fit. Ask for fewer.")


def main(seed: int, trees: int = 150) -> None:
    """Print the world."""
    models = "".join(
        TREE.format(i=i, x=x, y=y, z=HEIGHT / 2, radius=radius, height=HEIGHT)
        for i, (x, y, radius) in enumerate(place_trees(seed, trees))
    )
    print(WORLD.format(arguments=" ".join(sys.argv[1:]), models=models), end="")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*map(int, sys.argv[1:]))
