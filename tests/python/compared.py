"""A comparison of toys, and what it wrote."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

FLIGHT = ["--engine", "eigen", "--duration", "0.1", "--commands", "c.csv"]


@pytest.fixture(autouse=True)
def commands(toy):
    Path("c.csv").write_text("t,w1\n0,400\n0.05,-300\n")


def line_of(name, text):
    return 1 + Path(name).read_text().split(text)[0].count("\n")


def rows(name="out/table.csv"):
    with open(name, newline="") as stream:
        return list(csv.DictReader(stream))
