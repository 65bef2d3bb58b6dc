#!/usr/bin/env python3
"""Run suites one after the other under one master: ``run_suites.py PREFIX SUITE...``.

Each suite runs in a process of its own, with parameters of its own, and prints into the file
PREFIXSUITE.log. What all suites import is imported once.
"""

import contextlib
import os
import runpy
import signal
import sys
import xmlrpc.client
from pathlib import Path

import harness  # noqa: F401, which imports what all suites need
import rosgraph
import rospy


def list_parameters() -> set:
    """Names of the top-level parameters."""
    return set(rosgraph.Master("/suites").getParam("/"))


def end_nodes() -> None:
    """Kill the nodes that a suite has left, which would disturb the next."""
    master = rosgraph.Master("/suites")
    names = {name for part in master.getSystemState() for _, nodes in part for name in nodes}
    for name in names - {"/rosout"}:
        with contextlib.suppress(OSError, rosgraph.MasterException):
            uri = master.lookupNode(name)
            pid = xmlrpc.client.ServerProxy(uri).getPid("/suites")[2]
            print(f"{name} is left, and killed.")
            os.kill(pid, signal.SIGKILL)


def run_suite(name: str, prefix: str) -> None:
    """Run a suite in a process of its own, to its end."""
    child = os.fork()
    if child:
        os.waitpid(child, 0)
        end_nodes()
        return
    with open(f"{prefix}{name}.log", "w") as log:
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
            os.dup2(log.fileno(), stream.fileno())
    sys.argv = [str(Path(__file__).with_name(f"test_{name}.py")), "--text"]
    rospy.names.reload_mappings(sys.argv)
    runpy.run_path(sys.argv[0], run_name="__main__")
    sys.exit()


def run_suites(prefix: str, names: list) -> None:
    """Run suites, and delete the parameters that each leaves."""
    known = list_parameters()
    for name in names:
        run_suite(name, prefix)
        for parameter in list_parameters() - known:
            rosgraph.Master("/suites").deleteParam(f"/{parameter}")


if __name__ == "__main__":
    prefix, *names = (
        word for word in sys.argv[1:] if not word.startswith("-") and ":=" not in word
    )
    run_suites(prefix, names)
