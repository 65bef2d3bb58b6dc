"""Base class of wrappers for user-defined controllers."""

from __future__ import annotations

from typing import Any, Optional

from .compiled_controller import CompiledController, find_compiled
from .controller import check_callable


class WrappedController:
    """Controller that forwards its calls and attributes to a user-defined controller.

    Raises
    ------
    InputError
        If the object cannot be called as a controller.
    """

    def __init__(self, controller: Any) -> None:
        check_callable(controller)
        self.__dict__.update(_controller=controller)

    @property
    def compiled(self) -> Optional[CompiledController]:
        """Compiled controller that the core can call instead; None if it does not exist."""
        return find_compiled(self._controller)

    def __getattr__(self, name: str) -> Any:
        if name == "_controller":  # copy and pickle access it before it is set
            raise AttributeError(name)
        return getattr(self._controller, name)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Call the controller."""
        return self._controller(t, state, reference)
