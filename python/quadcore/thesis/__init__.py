"""Mathematical model of chapter 2 and validation of chapter 6 of the thesis."""

LAGRANGE = "lagrange"
"""Name of the mathematical model of chapter 2 in lists of engines."""

LAGRANGE_SUMMARY = "the mathematical model of chapter 2: no contact, no forces of plugins"
