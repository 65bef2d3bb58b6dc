"""HTML tables without scripts, for notebooks."""

from __future__ import annotations

from html import escape
from typing import Iterable, Sequence

SHOWN_ROWS = 30
"""Maximum number of rows of a table."""


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]], count: int = 0) -> str:
    """Make an HTML table of texts.

    Parameters
    ----------
    heads
        Column headings; empty for a table without them.
    rows
        At most `SHOWN_ROWS` rows.
    count
        Number of all rows; the table states how many are not shown.
    """
    head = "".join(f"<th>{escape(cell)}</th>" for cell in heads)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    more = f"<p>{count - SHOWN_ROWS} more rows</p>" if count > SHOWN_ROWS else ""
    top = f"<thead><tr>{head}</tr></thead>" if heads else ""
    return f"<table>{top}<tbody>{body}</tbody></table>{more}"


def html_title(described: object) -> str:
    """Make a paragraph of the `repr` of an object, without its angle brackets."""
    return f"<p>{escape(repr(described)[1:-1])}</p>"
