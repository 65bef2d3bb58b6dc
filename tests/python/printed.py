"""Compares the output that a page shows with what its command prints."""

from __future__ import annotations

import re

NUMBER = re.compile(r"(?<![\w.])([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?![\w.]*\w)")
GAP = "..."


def check_printed(expected, printed, tolerance=0.0):
    """Raise AssertionError unless the words are equal, and the numbers within a relative tolerance.

    `...` stands for any text. If there is a tolerance, columns may have other widths, and a number
    may also differ by one in its last digit.
    """
    pattern = (
        make_pattern(expected) if tolerance else ".*?".join(map(re.escape, expected.split(GAP)))
    )
    match = re.fullmatch(pattern, printed, re.DOTALL)
    assert match, f"the page shows\n{expected}\nbut it prints\n{printed}"
    shown = filter(NUMBER.fullmatch, split(expected))
    for wanted, found in zip(shown, match.groups()):
        allowed = max(tolerance * abs(float(wanted)), 1.001 * find_last_digit(wanted))
        assert abs(float(found) - float(wanted)) <= allowed, (
            f"the page shows {wanted}, but it prints {found}:\n{printed}"
        )


def split(text):
    """Split a text at its gaps, spaces and numbers, and keep these."""
    parts = re.split(r"(\.\.\.|\s+)", text)
    return [piece for part in parts for piece in ([part] if part == GAP else NUMBER.split(part))]


def make_pattern(text):
    """Return the regular expression of all texts that differ only in numbers and widths."""
    pattern = ""
    for part in split(text):
        if part == GAP:
            pattern += ".*?"
        elif part.isspace():
            pattern += r"\s+"
        elif NUMBER.fullmatch(part):
            pattern += r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
        else:
            pattern += re.escape(part)
    return pattern


def find_last_digit(number):
    """Return the value of one in the last digit of a number."""
    mantissa, _, exponent = number.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
