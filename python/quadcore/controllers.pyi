"""Public name of quadcore.control.controllers, for type checkers."""

from .control.controllers import *
