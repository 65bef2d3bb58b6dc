"""Expansion of xacro files with the source line of every element.

xacro itself does not keep line numbers. During an expansion, this module replaces the parser of
xacro. The elements of the new parser contain their line, for the result and for error messages.
"""

from __future__ import annotations

import contextlib
import glob
import io
import os
import traceback
from pathlib import Path
from types import FrameType, SimpleNamespace
from typing import Any, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Set, Tuple

import rospkg
import xacro

from .._core import InputError, QuadcoreError
from ..support.import_lock import LOCK
from ..support.input_files import read_text
from ..support.parameters import suggest
from ..support.warning import suppress_warnings, warn
from . import resources, xml_origins, xml_source
from .expansion_cache import Dependencies, ExpansionCache, read_content
from .xacro_faults import explain_error

_MOST_ELEMENTS = 20000  # a few lines of macros can expand to billions of elements


_Lines = List[Tuple[str, xml_source.Origin]]


class _Expansion(NamedTuple):
    lines: _Lines
    arguments: Dict[str, str]
    """Value of each argument."""
    asked: Set[str]


_CACHE: ExpansionCache[_Expansion] = ExpansionCache()


def expand(path: str, arguments: Mapping[str, str]) -> _Lines:
    """Expand a xacro file, or return the cached expansion if nothing has changed.

    Parameters
    ----------
    path
        Xacro file.
    arguments
        Values of ``<xacro:arg>`` by name.

    Returns
    -------
    list of (str, Origin)
        Lines of the expanded document with their origins.

    Raises
    ------
    InputError
        If the file or an included file is invalid, or an argument does not exist.

    Warns
    -----
    QuadcoreWarning
        If xacro issues a warning.
    """
    expansion = _expand_cached(path, arguments)
    for name in arguments:
        if name not in expansion.asked:
            known = sorted(expansion.asked)
            near = suggest(name, known)
            remedy = f"Use one of {', '.join(known)}." if known else "Leave it out."
            raise InputError(f"{path}: has no xacro argument '{name}'.{near} {remedy}")
    return expansion.lines


def list_arguments(path: str, given: Mapping[str, str]) -> Dict[str, str]:
    """Return the given or default value of each argument of a xacro file.

    Raises
    ------
    InputError
        As for `expand`.
    """
    expansion = _expand_cached(path, given)
    return {name: text for name, text in expansion.arguments.items() if name in expansion.asked}


def _expand_cached(path: str, arguments: Mapping[str, str]) -> _Expansion:
    key = (path, tuple(sorted(arguments.items())))
    with LOCK:
        return _CACHE.get(key, lambda outside: _expand_file(path, arguments, outside))


def _expand_file(path: str, arguments: Mapping[str, str], outside: Dependencies) -> _Expansion:
    table = _Arguments(arguments)
    try:
        with _replace_hooks(table, outside):
            document = xacro.process_file(path, mappings=table)
    except QuadcoreError:
        raise
    except Exception as error:  # the exceptions of xacro have no common base class
        frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
        place = _find_place(reversed(frames)) or path
        raise InputError(
            f"{place}: {_blame_argument(path, arguments, explain_error(error))}"
        ) from error
    return _Expansion(xml_origins.write(document), dict(table), table.asked)


def _blame_argument(path: str, arguments: Mapping[str, str], what: str) -> str:
    """Name the argument in an error if the file expands without it."""
    for name, value in arguments.items():
        table = _Arguments({other: text for other, text in arguments.items() if other != name})
        try:
            with _replace_hooks(table, Dependencies()), suppress_warnings():
                xacro.process_file(path, mappings=table)
            default = table[name]
        except Exception:  # another argument, or several together, cause the error
            continue
        given = " ".join(value.split())
        return f"xacro argument '{name}' is '{given}' (default '{default}'): {what}"
    return what


class _Arguments(Dict[str, str]):
    """Argument table for xacro that records the names in use."""

    def __init__(self, given: Mapping[str, str]) -> None:
        super().__init__(given)
        self.asked: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)


@contextlib.contextmanager
def _replace_hooks(arguments: _Arguments, outside: Dependencies) -> Iterator[None]:
    old_parse, old_extension = xacro.parse, xacro.eval_extension
    old_all, old_text = xacro.eval_all, xacro.eval_text

    def parse(source: Any, filename: str | None = None) -> Any:
        if filename is not None:
            outside.ask(read_content, filename)
        if filename is None or not Path(filename).exists():
            return old_parse(source, filename)  # raises what <xacro:include optional=""> expects
        if not Path(filename).is_file():
            raise xacro.XacroException(
                f"{filename}: this is not a regular file. Include a xacro file."
            )
        return xml_origins.parse(filename, xml_source.read(Path(filename)))

    elements = 0

    def eval_all(node: Any, macros: Any, symbols: Any) -> None:
        nonlocal elements
        elements += 1
        if elements > _MOST_ELEMENTS:
            raise xacro.XacroException(
                f"expands to more than {_MOST_ELEMENTS} elements, the most that are read"
            )
        old_all(node, macros, symbols)

    def eval_text(text: str, symbols: Any) -> Any:
        result = old_text(text, symbols)
        if isinstance(result, str) and len(result) > xml_source.LARGEST:
            most = f"{xml_source.LARGEST / 1e6:g} MB, the most that is read"
            raise xacro.XacroException(f"expands to a text of more than {most}")
        return result

    def eval_extension(text: str) -> str:
        command, *words = text[len("$(") : -len(")")].split() or [""]
        if command == "find" and len(words) == 1:
            return outside.ask(_find_package, words[0])
        if command in ("env", "optenv") and words:
            outside.ask(os.environ.get, words[0])
        elif command not in ("arg", "cwd", "dirname"):  # eval, or anon, which changes each time
            outside.may_be_kept = False
        if command == "arg" and len(words) == 1 and words[0] not in arguments:
            raise xacro.XacroException(
                f"undefined xacro argument '{words[0]}'. Declare it: "
                f'<xacro:arg name="{words[0]}" default="..."/>'
            )
        return str(old_extension(text))

    def opened(filename: str) -> io.StringIO:  # for load_yaml
        outside.ask(read_content, filename)
        try:
            return io.StringIO(read_text(Path(filename)))
        except InputError as error:  # xacro expects the errors of open
            if isinstance(error.__cause__, OSError):
                raise error.__cause__ from None
            raise

    def warning(message: str) -> None:
        outside.may_be_kept = False  # a cached expansion would not repeat the warning
        place = _find_place(frame for frame, _ in traceback.walk_stack(None))
        warn(f"{place}: {message}" if place else message)

    new = {
        "parse": parse,
        "eval_all": eval_all,
        "eval_text": eval_text,
        "eval_extension": eval_extension,
        "warning": warning,
        "print_location": lambda *_: None,
        "glob": SimpleNamespace(glob=lambda pattern: outside.ask(glob.glob, pattern)),
        "open": opened,
    }
    old = {name: value for name, value in vars(xacro).items() if name in new}
    vars(xacro).update(new)
    try:
        yield
    finally:
        for name in new:
            del vars(xacro)[name]
        vars(xacro).update(old)


def _find_package(name: str) -> str:
    if name == "quadcore":  # pip does not install it into a ROS workspace
        return str(resources.find_root())
    try:
        return str(rospkg.RosPack().get_path(name))
    except rospkg.ResourceNotFound:
        raise xacro.XacroException(
            f"package '{name}' not found. Add the folder that contains it to ROS_PACKAGE_PATH."
        ) from None


def _find_place(frames: Iterable[FrameType]) -> xml_source.Origin | None:
    """Return the origin of the element that xacro is expanding, from the innermost frame."""
    for frame in frames:
        for name in ("node", "elt", "tag"):  # names of the element in xacro
            found = xml_origins.find_origin(frame.f_locals.get(name))
            if found is not None:
                return found
    return None
