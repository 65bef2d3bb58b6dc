"""Base of classes that wrap a user-defined controller."""

from __future__ import annotations

from typing import Any, Optional

from .compiled_controller import CompiledController, find_compiled
from .controller import check_callable


class WrappedController:
    """Controller with the calls and attributes of a user-defined one.

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
        """The compiled controller that the core may call in its place."""
        return find_compiled(self._controller)

    def __getattr__(self, name: str) -> Any:
        if name == "_controller":  # copy and pickle ask before it is set
            raise AttributeError(name)
        return getattr(self._controller, name)

    def __call__(self, t: float, state: Any, reference: Any) -> Any:
        """Call the controller."""
        return self._controller(t, state, reference)
