"""What a page's shell finds under the names of quadcore and of programs that tests cannot start.

See `pages`; the first argument is the program's name.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

FEW = {"--samples": "2"}
SHORT = {"--duration": "1", "--seeds": "1", "--budget": "2", "--no-plots": None, **FEW}
CHANGES = {"no": {}, "no-plots": {"--no-plots": None}, "": FEW, "yes": SHORT}
"""Options to add, by QUADCORE_SHORT."""


def quadcore(words):
    """As typed; but a server goes on, and what shows no output flies few rows, or is short."""
    from quadcore.cli import make_parser

    parser = make_parser()
    given = parser.parse_args(words)
    known = parser._subparsers._group_actions[0].choices[words[0]]._option_string_actions
    # Options behind the first --model of a fleet are those of one vehicle.
    end = words.index("--model") if words[0] == "run" and "--model" in words else len(words)
    for option, value in CHANGES[os.environ["QUADCORE_SHORT"]].items():
        if option in known and not getattr(given, "plant", None):  # that has its own length
            words[end:end] = [option] + ([value] if value else [])
    if getattr(given, "dask", None):  # there is no such cluster
        at = words.index("--dask")
        del words[at : at + 2]
    if words[0] != "serve":
        run_quadcore(words)
    command = [sys.executable, "-m", "quadcore", *words]
    if "--port" in words:
        command[command.index("--port") + 1] = "0"  # which nobody else has
    quiet = subprocess.DEVNULL  # or who waits for the page would wait for it
    served = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=quiet, text=True)
    address = served.stdout.readline()
    assert address.startswith("serving ")
    Path("served").write_text(f"{address.rpartition(':')[2].strip()} {served.pid}")


def run_quadcore(words):
    """Run quadcore as typed."""
    from quadcore.__main__ import run

    sys.argv[1:] = words
    run()


def python(words):
    """Run a text as `python -c` does."""
    sys.argv[:] = ["-c"]
    sys.path.insert(0, "")
    main = sys.modules["__main__"] = type(sys)("__main__")
    exec(compile(words[0], "<string>", "exec"), main.__dict__)


def pip(words):
    """Install nothing; but the extras must exist."""
    from importlib.metadata import metadata

    for word in words:
        for extra in re.findall(r"quadcore\[(.*)\]", word):
            assert set(extra.split(",")) <= set(metadata("quadcore").get_all("Provides-Extra"))


def git(words):
    """Make the folder of a clone."""
    assert words[0] == "clone"
    Path(words[-1]).mkdir(parents=True)


def catkin_make(words):
    Path("devel").mkdir(exist_ok=True)
    Path("devel/setup.bash").touch()


if __name__ == "__main__":
    program = globals().get(sys.argv[1])
    if callable(program):
        program(sys.argv[2:])
