"""Tables of HTML that needs no script: what a notebook shows of an object."""

from __future__ import annotations

from html import escape
from typing import Iterable, Sequence

SHOWN_ROWS = 30
"""That a table has at most."""


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]], count: int = 0) -> str:
    """Make a table of texts.

    Parameters
    ----------
    heads
        Of the columns; none: the table has no head.
    rows
        At most `SHOWN_ROWS`.
    count
        Of all rows; the table says how many are not shown.
    """
    head = "".join(f"<th>{escape(cell)}</th>" for cell in heads)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    more = f"<p>{count - SHOWN_ROWS} more</p>" if count > SHOWN_ROWS else ""
    top = f"<thead><tr>{head}</tr></thead>" if heads else ""
    return f"<table>{top}<tbody>{body}</tbody></table>{more}"


def html_title(described: object) -> str:
    """Make a paragraph of the text of an object, without its angle brackets."""
    return f"<p>{escape(repr(described)[1:-1])}</p>"
