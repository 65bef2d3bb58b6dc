"""Parsers for the values of command-line options."""

from __future__ import annotations

import argparse
import re
from typing import Callable, Sequence

from .._core import parse_number
from .arguments import MEASURED


def assignment(pattern: str, form: str) -> Callable[[str], tuple[str, str]]:
    """Return a parser that splits ``KEY=VALUE`` into the two groups of `pattern`."""

    def parse(text: str) -> tuple[str, str]:
        match = re.fullmatch(pattern, text, re.DOTALL)
        if match is None:
            raise argparse.ArgumentTypeError(f"'{text}' is not of the form {form}")
        return match.group(1), match.group(2)

    return parse


def several(names: Sequence[str]) -> Callable[[str], list[str]]:
    """Return a parser for comma-separated names from a list."""

    def parse(text: str) -> list[str]:
        for name in text.split(","):
            if name not in names:
                raise argparse.ArgumentTypeError(
                    f"'{name}' does not exist. Choose from {', '.join(names)}"
                )
        return list(dict.fromkeys(text.split(",")))

    return parse


def names(text: str) -> list[str]:
    """Parse comma-separated names."""
    return _named(text, text.split(","))


def several_calls(text: str) -> list[str]:
    """Parse comma-separated names, optionally as ``NAME:KEY=VALUE,KEY=VALUE``."""
    found: list[str] = []
    for part in text.split(","):
        if found and "=" in part and ":" not in part.partition("=")[0]:
            found[-1] += f",{part}"
        else:
            found.append(part)
    return _named(text, found)


def _named(text: str, found: list[str]) -> list[str]:
    if not all(found):
        raise argparse.ArgumentTypeError(
            f"'{text}' has an empty name. Write names with commas between them"
        )
    return found


def positive_numbers(text: str) -> list[float]:
    """Parse comma-separated positive numbers."""
    return list(dict.fromkeys(positive(part) for part in text.split(",")))


def positive(text: str) -> float:
    """Parse a number greater than 0."""
    value = finite(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"{text} is not greater than 0")
    return value


def not_negative(text: str) -> float:
    """Parse a number of at least 0."""
    value = finite(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text} is less than 0")
    return value


def computation_time(text: str) -> float | str:
    """Parse a number of at least 0, or the word ``measured``."""
    return text if text == MEASURED else not_negative(text)


def finite(text: str) -> float:
    """Parse a finite number."""
    value = parse_number(text)
    if value is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


def integer(lowest: int, highest: int = 10**18) -> Callable[[str], int]:
    """Return a parser for an integer from `lowest` to `highest`."""

    def parse(text: str) -> int:
        if not re.fullmatch(r"[0-9]+", text) or int(text) < lowest:
            raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {lowest} on")
        if int(text) > highest:
            raise argparse.ArgumentTypeError(f"{text} exceeds {highest}")
        return int(text)

    return parse


def pose(text: str) -> tuple[float, ...]:
    """Parse ``x,y,z[,roll,pitch,yaw]``, separated by commas or spaces."""
    return _numbers(text, "x,y,z[,roll,pitch,yaw]", (3, 6))


def vector(text: str) -> tuple[float, ...]:
    """Parse ``x,y,z``, separated by commas or spaces."""
    return _numbers(text, "x,y,z", (3,))


def location(text: str) -> tuple[float, ...]:
    """Parse ``latitude,longitude[,altitude]``, separated by commas or spaces."""
    return _numbers(text, "latitude,longitude[,altitude]", (2, 3))


def _numbers(text: str, form: str, counts: Sequence[int]) -> tuple[float, ...]:
    values = tuple(finite(part) for part in re.split(r"\s*,\s*|\s+", text.strip()))
    if len(values) not in counts:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form {form}")
    return values
