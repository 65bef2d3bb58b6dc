"""Simulation server: other processes step a flight over a socket; see docs/serve.md."""

from __future__ import annotations

from .client import Client, ServerError
from .server import Server

__all__ = ["Client", "Server", "ServerError"]
