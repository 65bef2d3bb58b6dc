"""Lock that is never held across a fork."""

from __future__ import annotations

import os
import threading

LOCK = threading.RLock()
"""Lock for late imports, and for xacro, which keeps its state in globals.

Forks wait for it, because a child would otherwise wait forever for a thread that it does not have.
"""

os.register_at_fork(before=LOCK.acquire, after_in_parent=LOCK.release, after_in_child=LOCK.release)
