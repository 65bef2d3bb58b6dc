"""Calls the Python bindings with odd arguments; seed and number alone make each input."""

from __future__ import annotations

import argparse
import mmap
import random
import struct
import time
import warnings
from pathlib import Path
from typing import Callable, Dict

import arguments
import batches
import messages
import objects
import pickles

TARGETS: Dict[str, Callable[[], Callable[[random.Random], None]]] = {
    "arguments": arguments.target,
    "batches": batches.target,
    "messages": messages.target,
    "objects": objects.target,
    "pickles": pickles.target,
}
"""Each makes what it needs and returns what is called for every input."""


def main() -> None:
    """Run the inputs that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first input")
    parser.add_argument("--runs", type=int, default=2**62, help="inputs (default: until the time)")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--number", type=Path, help="file that holds the present input's number")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    run = TARGETS[options.target]()
    chance = random.Random()
    present = _number(options.number) if options.number else bytearray(8)
    begin = time.monotonic()
    done = 0
    while done < options.runs and time.monotonic() - begin < options.seconds:
        number = options.first + done
        struct.pack_into("<q", present, 0, number)
        chance.seed(number * 2**32 + options.seed)
        try:
            run(chance)
        except BaseException:
            print(f"{options.target}: input {number} of seed {options.seed}", flush=True)
            raise
        done += 1
    seconds = time.monotonic() - begin
    print(f"{options.target}: {done} inputs in {seconds:.0f} s, seed {options.seed}, no finding")


def _number(path: Path) -> mmap.mmap:
    """Map a file, which holds the last number even if the process is ended."""
    path.write_bytes(bytes(8))
    with path.open("r+b") as file:
        return mmap.mmap(file.fileno(), 8)


main()
