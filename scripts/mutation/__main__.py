"""Runs mutation tests: changes one line of the core at a time and runs the tests.

    scripts/mutate [--count N] [--seed N] [PART ...]

The seed selects mutants from all possible ones. Verdicts are in build/mutation/results.csv: a run
continues the last one, and repeats survivors after a test has changed.
"""

from __future__ import annotations

import argparse
import random
import sys
from pathlib import Path
from typing import Callable, Iterable

from operators import mutants_of
from plan import PARTS
from results import Results, explained, sorted_out
from workshop import Workshop

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "mutation"
REASONS = Path(__file__).with_name("survivors.txt")


def main() -> int:
    """Run; returns 1 if a mutant survives without a reason, 130 if interrupted."""
    names = [part.name for part in PARTS]
    parser = argparse.ArgumentParser(prog="scripts/mutate", description=__doc__.split("\n")[0])
    parser.add_argument(
        "parts", nargs="*", metavar="PART", help=f"part (default: all): {', '.join(names)}"
    )
    parser.add_argument("--count", type=int, default=600, help="number of mutants (default: 600)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the selection (default: 1)")
    options = parser.parse_args()
    unknown = set(options.parts) - set(names)
    if unknown:
        parser.error(f"unknown part {', '.join(sorted(unknown))}. Choose from {', '.join(names)}.")

    drawn = [
        (part, mutant)
        for part in PARTS
        for file in part.sources
        for mutant in mutants_of(file, (ROOT / file).read_text(encoding="utf-8"))
    ]
    random.Random(options.seed).shuffle(drawn)
    wanted = [d for d in drawn if d[0].name in (options.parts or names)][: options.count]
    chosen = dict(enumerate(wanted, 1))

    results = Results(FOLDER / "results.csv", ROOT)
    verdicts = {n: results.known(mutant) for n, (_, mutant) in chosen.items()}
    new = {n: mutant for n, (_, mutant) in chosen.items() if verdicts[n] is None}
    status = 0

    def judge(numbers: Iterable[int], verdict_of: Callable[[int], str]) -> None:
        for n in numbers:
            part, mutant = chosen[n]
            workshop.prepare(part)
            verdicts[n] = verdict = verdict_of(n)
            results.add(part.name, mutant, verdict)
            done = sum(v is not None for v in verdicts.values())
            place = f"{mutant.file}:{mutant.line}"
            print(f"[{done}/{len(chosen)}] {verdict}: {place}: {mutant.after.strip()}")

    try:
        if new:
            workshop = Workshop(ROOT, FOLDER)
            print(f"building {len(new)} mutants together")
            together = workshop.build_together(new)
            judge(sorted(together), lambda n: workshop.chosen(chosen[n][0], n))
            alone = sorted(set(new) - together, key=lambda n: new[n].file)
            if alone:
                print(f"building {len(alone)} mutants one by one")
                workshop.build_originals()
                judge(alone, lambda n: workshop.alone(chosen[n][0], new[n]))
    except KeyboardInterrupt:
        status = 130
    table, unexplained = sorted_out(
        [(chosen[n][0].name, chosen[n][1], verdict) for n, verdict in verdicts.items() if verdict],
        explained(REASONS),
    )
    for m in unexplained:
        print(f"\n{m.file}:{m.line} survived\n- {m.before.strip()}\n+ {m.after.strip()}")
    print(f"\n{table}")
    return status or int(bool(unexplained))


if __name__ == "__main__":
    sys.exit(main())
