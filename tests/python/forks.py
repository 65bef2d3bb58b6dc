"""A process with all imports done, which forks to run each command of a page.

Python with quadcore, scipy and matplotlib starts in a second, a fork in some milliseconds. The
parent starts `python forks.py SOCKET`, which serves until its standard input ends. The client, in
`python -IS forks.py SOCKET PROGRAM WORD...`, sends its folder, environment, standard streams and
words. A fork of the server calls the function PROGRAM of `stand_in` with them, ends like any
interpreter, and the client exits with its status.
"""

from __future__ import annotations

import array
import gc
import importlib
import json
import os
import select
import socket
import sys

IMPORTED = (
    "matplotlib.backends.backend_svg",
    "printed",
    "quadcore.__main__",
    "quadcore.report.log_plots",
    "quadcore.report.page",
    "quadcore.studies.compare.output",
    "quadcore.studies.compare.plots",
    "quadcore.studies.evaluate.output",
    "quadcore.studies.evaluate.plots",
    "quadcore.studies.fit.output",
    "quadcore.studies.sweep.output",
    "quadcore.studies.sweep.plots",
    "quadcore.studies.tune.output",
    "scipy.linalg",
    "scipy.ndimage",
    "scipy.optimize",
    "scipy.signal",
    "scipy.spatial.transform",
    "scipy.stats",
)


def ask(address, program, words):
    """Run a program in a fork of the server, with the streams of this process; its status."""
    request = {
        "program": program,
        "words": words,
        "folder": os.getcwd(),
        "environment": dict(os.environ),
    }
    with socket.socket(socket.AF_UNIX) as connection:
        connection.connect(address)
        streams = array.array("i", (0, 1, 2))
        connection.sendmsg([b"*"], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, streams)])
        connection.sendall(json.dumps(request).encode())
        connection.shutdown(socket.SHUT_WR)
        answer = connection.makefile().read()
    return int(answer or 1)


def serve(address):
    """Serve, and return None at the end; in each fork, return its request."""
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(address)
        listener.listen(16)
        print("ready", flush=True)
        while sys.stdin not in select.select([listener, sys.stdin], [], [])[0]:
            with listener.accept()[0] as connection:
                attendant = os.fork()
                if attendant == 0:
                    return attend(connection)
            while reap():
                pass
    return None


def attend(connection):
    """Receive a request and fork: return it in the fork, and here send the status and end."""
    size = 3 * array.array("i").itemsize
    (_, _, streams), *_ = connection.recvmsg(1, socket.CMSG_LEN(size))[1]
    request = json.loads(connection.makefile().read())
    child = os.fork()
    if child == 0:
        for number, stream in enumerate(array.array("i", streams)):
            os.dup2(stream, number)
            os.close(stream)
        return request
    _, status = os.waitpid(child, 0)
    ended = os.WEXITSTATUS(status) if os.WIFEXITED(status) else 128 + os.WTERMSIG(status)
    connection.sendall(str(ended).encode())
    os._exit(0)


def reap():
    """Whether an attendant has ended that nobody had waited for."""
    try:
        return os.waitpid(-1, os.WNOHANG)[0] != 0
    except ChildProcessError:
        return False


def main():
    """Be a client if a program is named, else the server."""
    address, *command = sys.argv[1:]
    if command:
        sys.exit(ask(address, command[0], command[1:]))
    for name in IMPORTED:
        importlib.import_module(name)
    stand_in = importlib.import_module("stand_in")
    del sys.path[0]  # which is this folder
    gc.freeze()  # so that forks share the pages of memory
    request = serve(address)
    if request:
        os.chdir(request["folder"])
        sys.stderr = os.fdopen(2, "w", 1, errors="backslashreplace", closefd=False)
        os.environ.clear()
        os.environ.update(request["environment"])
        getattr(stand_in, request["program"])(request["words"])


if __name__ == "__main__":
    main()
