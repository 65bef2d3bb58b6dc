"""Public name of quadcore.control.references, for type checkers."""

from .control.references import *
