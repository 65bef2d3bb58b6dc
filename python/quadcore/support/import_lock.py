"""Lock that is never held across a fork."""

from __future__ import annotations

import os
import threading

LOCK = threading.RLock()
"""Lock for late imports, and for xacro, which has global state.

A fork waits for this lock. Otherwise the child could wait forever for a thread that exists only in
the parent.
"""

os.register_at_fork(before=LOCK.acquire, after_in_parent=LOCK.release, after_in_child=LOCK.release)
