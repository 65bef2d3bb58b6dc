"""A flight driven from outside the process, in lockstep over a socket: see docs/serve.md."""

from __future__ import annotations

from .client import Client, ServerError
from .server import Server

__all__ = ["Client", "Server", "ServerError"]
