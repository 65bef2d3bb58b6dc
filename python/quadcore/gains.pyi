"""Public name of quadcore.control.gains, for type checkers."""

from .control.gains import *
