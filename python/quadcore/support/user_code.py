"""Controllers of the user's own, by the name of their module."""

from __future__ import annotations

import importlib
import inspect
import os
import sys
import traceback
from contextlib import suppress
from typing import Any

from .._core import InputError


def import_controller(text: str) -> Any:
    """Bring in a controller.

    Parameters
    ----------
    text
        ``MODULE:NAME``: a class, which is made without arguments, or what can be called as a
        controller. The module is looked for in the working folder, too.

    Raises
    ------
    InputError
        No such module or name, or one of them fails.
    """
    module, _, name = text.partition(":")
    here = os.getcwd()
    sys.path.insert(0, here)
    try:
        found = getattr(importlib.import_module(module), name)
        controller = found() if inspect.isclass(found) else found
    except ModuleNotFoundError as error:
        if not f"{module}.".startswith(f"{error.name}."):
            raise _failed(text, error) from error
        raise InputError(
            f"controller '{text}': there is no module '{module}' here or on PYTHONPATH"
        ) from error
    except AttributeError as error:
        if module not in sys.modules or hasattr(sys.modules[module], name):
            raise _failed(text, error) from error
        raise InputError(f"controller '{text}': module '{module}' has no '{name}'") from error
    except (KeyboardInterrupt, MemoryError):
        raise
    except BaseException as error:  # SystemExit, too
        raise _failed(text, error) from error
    finally:
        with suppress(ValueError):  # the module may have seen to it itself
            sys.path.remove(here)
    if not callable(controller):
        raise InputError(
            f"controller '{text}': it cannot be called as controller(t, state, reference)"
        )
    return controller


def describe_error(error: BaseException) -> str:
    """Say in one line what was raised, and where."""
    if isinstance(error, SyntaxError) and error.filename:
        kind, reason, file, line = type(error).__name__, error.msg, error.filename, error.lineno
    else:
        place = traceback.extract_tb(error.__traceback__)[-1]
        kind, reason, file, line = type(error).__name__, f"{error}", place.filename, place.lineno
    return " ".join(f"{kind}: {reason}".split()) + f" ({file}:{line})"


def _failed(text: str, error: BaseException) -> InputError:
    return InputError(f"controller '{text}': {describe_error(error)}")
