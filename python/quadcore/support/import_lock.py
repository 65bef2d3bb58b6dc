"""A lock that no fork catches closed."""

from __future__ import annotations

import os
import threading

LOCK = threading.RLock()
"""Held while a module is imported late or xacro, which keeps its stacks in globals, expands a file.

A process is not forked meanwhile: the child would wait for the other thread without end.
"""

os.register_at_fork(before=LOCK.acquire, after_in_parent=LOCK.release, after_in_child=LOCK.release)
