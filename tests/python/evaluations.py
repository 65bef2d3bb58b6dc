"""What tests of evaluations share."""

from __future__ import annotations

import csv

import quadcore as qc

FLY = ["evaluate", "--xacro", "sim_slow:=1", "--duration", "1"]


def evaluate(*arguments, **options):
    given = {"xacro_args": {"sim_slow": 1}, "duration": 1.0, **options}
    return qc.evaluate(*arguments, **given)


def rows(file="out/table.csv"):
    with open(file) as stream:
        return list(csv.DictReader(stream))
