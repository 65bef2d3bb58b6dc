"""The thesis: the mathematical model of its chapter 2, and the validation of its chapter 6."""

LAGRANGE = "lagrange"
"""Name of the mathematical model of chapter 2 among the engines."""

LAGRANGE_SUMMARY = "the mathematical model of chapter 2: no contact, no forces of plugins"
