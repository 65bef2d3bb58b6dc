"""Controllers in modules and files of the user."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import os
import sys
import traceback
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, Callable, Iterator, List, NamedTuple

from .._core import InputError
from .input_files import check_regular

_FORM = "controller(t, state, reference)"


class SplitName(NamedTuple):
    """Parts of the name of a user-defined controller."""

    place: str
    """Module, or path that ends in .py or .so."""
    name: str
    """Name of the object in the module or file; "" if none is given."""
    values: str
    """Parameters as ``KEY=VALUE,...``."""


def split_name(text: str) -> SplitName:
    """Split ``MODULE:NAME`` or ``FILE.py[:NAME]``, optionally followed by ``:KEY=VALUE,...``."""
    head, colon, values = text.rpartition(":")
    if not (colon and "=" in values):
        head, values = text, ""
    if head.endswith((".py", ".so")):
        return SplitName(head, "", values)
    place, _, name = head.rpartition(":")
    return SplitName(place, name, values)


def names_file(text: str) -> bool:
    """Return whether a text names a controller in a file."""
    return split_name(text).place.endswith(".py")


def find_controller(text: str, make: Callable[[Any], Any]) -> Any:
    """Import a controller as `find_object` does; also raise `InputError` if it is not callable."""
    controller = find_object(f"controller '{text}'", text, make)
    if not callable(controller):
        raise InputError(f"controller '{text}': it cannot be called as {_FORM}. Define it so.")
    return controller


def find_object(who: str, text: str, make: Callable[[Any], Any]) -> Any:
    """Import a user-defined object.

    Parameters
    ----------
    who
        Kind and name of the object for messages.
    text
        Name, as for `split_name`. Modules in the working folder can be imported. A file without
        NAME must define exactly one controller: a class with a method ``__call__``, or a function.
    make
        Function that makes the result from the imported class or object.

    Raises
    ------
    InputError
        If the module, the file or the name does not exist, or its code fails.
    """
    place, name, _ = split_name(text)
    if not place:
        raise InputError(f"{who}: no name is given. Write MODULE:NAME or FILE.py.")
    is_file = place.endswith(".py")
    if is_file:
        check_regular(Path(place))
    find = _find_in_file if is_file else _find_in_module
    folder = os.path.dirname(os.path.realpath(place)) if is_file else os.getcwd()
    try:
        with _importing_from(folder):
            return make(find(who, place, name))
    except (InputError, KeyboardInterrupt, MemoryError):
        raise
    except BaseException as error:  # includes SystemExit
        raise InputError(f"{who}: {describe_error(error)}") from error


def _find_in_module(who: str, module: str, name: str) -> Any:
    try:
        return getattr(importlib.import_module(module), name)
    except ModuleNotFoundError as error:
        if not f"{module}.".startswith(f"{error.name}."):
            raise
        raise InputError(
            f"{who}: there is no module '{module}' here or on PYTHONPATH. "
            "Correct its name, or name its file."
        ) from error
    except AttributeError as error:
        if module not in sys.modules or hasattr(sys.modules[module], name):
            raise
        raise InputError(
            f"{who}: module '{module}' has no '{name}'. Name one of its classes or functions."
        ) from error


def _find_in_file(who: str, file: str, name: str) -> Any:
    module = _import_file(file)
    if name:
        if not hasattr(module, name):
            raise InputError(f"{who}: {file} has no '{name}'")
        return getattr(module, name)
    own = [x for x in vars(module).values() if getattr(x, "__module__", "") == module.__name__]
    classes = [x for x in own if inspect.isclass(x) and _defines_call(x)]
    found: List[Any] = classes or [x for x in own if inspect.isfunction(x) and _takes_three(x)]
    if len(found) != 1:
        names = ", ".join(f"{file}:{each.__name__}" for each in found)
        what = f"Name one: {names}." if found else f"Define a class or function {_FORM}."
        raise InputError(f"{who}: {file} has {len(found)} controllers. {what}")
    return found[0]


def _defines_call(kind: type) -> bool:
    return any("__call__" in vars(base) for base in kind.__mro__)


def _takes_three(function: Callable[..., Any]) -> bool:
    try:
        inspect.signature(function).bind(0.0, None, None)
    except TypeError:
        return False
    return not function.__name__.startswith("_")


def _import_file(file: str) -> ModuleType:
    """Import a file unless it is already imported."""
    path = os.path.realpath(file)
    name = f"quadcore controller {path}"  # cannot hide a module with another name
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        assert spec is not None and spec.loader is not None  # because the suffix is .py
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module  # dataclasses look up their module
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


@contextmanager
def _importing_from(folder: str) -> Iterator[None]:
    """Search a folder first for modules during the block."""
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        if folder in sys.path:  # the module may have removed it
            sys.path.remove(folder)


def describe_error(error: BaseException) -> str:
    """Describe an exception and its source line in one line."""
    if isinstance(error, SyntaxError) and error.filename:
        kind, reason, file, line = type(error).__name__, error.msg, error.filename, error.lineno
    else:
        place = traceback.extract_tb(error.__traceback__)[-1]
        kind, reason, file, line = type(error).__name__, f"{error}", place.filename, place.lineno
    return " ".join(f"{kind}: {reason}".split()) + f" ({file}:{line})"
