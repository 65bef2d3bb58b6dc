"""Server of one page on this machine, and of the rows of a flight that goes on."""

from __future__ import annotations

import http.server
import json
import os
import socket
import sys
import threading
import time
import webbrowser
from contextlib import suppress
from typing import Any, Dict, List, Optional, Sequence

from .._core import InputError

EVENTS = "/events"
"""Path of the rows, as server-sent events."""

_HOST = "127.0.0.1"
_PATIENCE = 10.0  # s, for a page that reads nothing
_LARGEST = 2000  # rows in one event
_HEARTBEAT = 5.0  # s, between two events when there is nothing new


class PageServer:
    """Server of a page; it sends the rows of a flight to every page that asks.

    Each page gets all rows once, however late it comes. A page that reads slowly or leaves does
    not delay the flight: rows are only stored here, and threads of the pages send them.

    Parameters
    ----------
    page : str
        HTML.
    port : int
        Port; 0: any free one.

    Attributes
    ----------
    url : str
        Address of the page.

    Raises
    ------
    InputError
        If the port cannot be used.
    """

    def __init__(self, page: str, port: int = 0) -> None:
        self._page = page.encode()
        self._rows: List[Sequence[Optional[float]]] = []
        self._reason: Optional[str] = None
        self._changed = threading.Condition()
        self._pages = 0
        self._served = 0
        handler = type("Handler", (_Handler,), {"owner": self})
        try:
            self._server = _Server((_HOST, port), handler)
        except OSError as error:
            raise InputError(
                f"port {port}: cannot be used: {error.strerror}. Give another port."
            ) from error
        self.port = self._server.server_address[1]
        self.url = f"http://{_HOST}:{self.port}/"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), daemon=True)
        self._thread.start()

    def append(self, rows: Sequence[Sequence[Optional[float]]]) -> None:
        """Store rows and wake the pages; never waits for one."""
        with self._changed:
            self._rows.extend(rows)
            self._changed.notify_all()

    def end(self, reason: str = "") -> None:
        """Send the pages the end of the flight and its reason."""
        with self._changed:
            self._reason = reason
            self._changed.notify_all()

    def wait_for_pages(self, patience: float) -> None:
        """Wait until every page has all rows; at most `patience` (s) for a first page to come.

        A page that reads an event within 10 s gets all rows, however many there are.
        """
        start = time.monotonic()
        with self._changed:
            while self._pages or not self._served:
                if not self._pages and time.monotonic() - start >= patience:
                    return
                self._changed.wait(0.2)

    def close(self) -> None:
        """Stop serving."""
        self.end(self._reason or "")
        self._server.shutdown()
        self._server.server_close()

    # ---- called by the threads of the pages ----

    def stream(self, first: int, send: Any) -> None:
        """Send rows from a number on until the flight has ended."""
        with self._changed:
            self._pages += 1
        try:
            while True:
                with self._changed:
                    if len(self._rows) <= first and self._reason is None:
                        self._changed.wait(_HEARTBEAT)
                    rows = self._rows[first : first + _LARGEST]
                    is_over = self._reason is not None and first + len(rows) == len(self._rows)
                if rows:
                    body = {"flight": 0, "first": first, "rows": rows}
                    first += len(rows)
                    send(f"id: {first}\nevent: rows\ndata: {json.dumps(body)}\n\n")
                elif not is_over:
                    send(": nothing new\n\n")
                if is_over:
                    send(f"event: end\ndata: {json.dumps({'reason': self._reason})}\n\n")
                    with self._changed:
                        self._served += 1
                    return
        finally:
            with self._changed:
                self._pages -= 1
                self._changed.notify_all()


class _Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, request: Any, client_address: Any) -> None:
        if not isinstance(sys.exc_info()[1], (OSError, ValueError)):  # a page that left
            super().handle_error(request, client_address)


class _Handler(http.server.BaseHTTPRequestHandler):
    owner: PageServer
    timeout = _PATIENCE

    def do_GET(self) -> None:
        # Another site must not read the flight through a name that it points to this machine.
        names = {f"{_HOST}:{self.owner.port}", f"localhost:{self.owner.port}"}
        if self.headers.get("Host") not in names:
            self.send_error(403, "This server answers to this machine only")
        elif self.path == "/":
            self._answer("text/html; charset=utf-8", {"Content-Length": str(len(self.owner._page))})
            self.wfile.write(self.owner._page)
        elif self.path.partition("?")[0] == EVENTS:
            self._answer("text/event-stream", {"X-Accel-Buffering": "no"})
            self.connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.owner.stream(self._first_row(), lambda text: self.wfile.write(text.encode()))
        elif self.path == "/favicon.ico":
            self.send_response(204)
            self.end_headers()
        else:
            self.send_error(404)

    def _answer(self, kind: str, more: Dict[str, str]) -> None:
        self.send_response(200)
        headers = {"Content-Type": kind, "Cache-Control": "no-store", **more}
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()

    def _first_row(self) -> int:
        """Return the number of the row that a page needs next; a reconnect has sent it."""
        with suppress(ValueError):
            return max(0, int(self.headers.get("Last-Event-ID", "0")))
        return 0

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing."""


def open_browser(url: str) -> bool:
    """Open a page in the user's browser, if there is a screen; returns whether it did."""
    has_screen = sys.platform == "darwin" or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    )
    return has_screen and webbrowser.open(url)
