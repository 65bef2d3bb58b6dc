"""Reports as self-contained HTML files."""

from __future__ import annotations

import base64
from pathlib import Path

import jinja2

from ..support.input_files import is_file
from ..support.output_files import atomic_write, encode_text
from .packing import compress

_FOLDER = Path(__file__).parent
_BUNDLE = _FOLDER / "bundle"  # scripts/bundle_player writes it
_PLAYER = '<section class="quadcore-player"'


def write_page(path: Path, template: str, **values: object) -> None:
    """Fill in a template and write the page; see `render`.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    page = render(template, **values)
    with atomic_write(path) as stream:
        stream.write(encode_text(page))


def render(template: str, **values: object) -> str:
    """Fill in a template.

    Parameters
    ----------
    template
        Name of a file in ``templates/``; pages extend ``page.html``. The filter ``image`` embeds a
        PNG: ``{{ bytes | image("caption") }}``.
    values
        Variables of the template; texts are escaped.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(_FOLDER / "templates")),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["image"] = embed_image
    text = environment.get_template(template).render(values)
    return _add_player(text) if _PLAYER in text and "</body>" in text else text


def has_player() -> bool:
    """Return whether this build of the package contains the script of the player."""
    return is_file(_BUNDLE / "player.js")


def _add_player(page: str) -> str:
    """Add the script, the style and the licences of the player, once for all players of a page."""
    script, style, licences = (
        (_BUNDLE / name).read_text(encoding="utf-8")
        for name in ("player.js", "player.css", "LICENSE.player")
    )
    end = render("player_script.html", script=compress(script.encode()), licences=licences)
    head, _, body = page.partition("</head>")
    body, _, rest = body.rpartition("</body>")
    return f"{head}<style>\n{style}</style>\n</head>{body}{end}\n</body>{rest}"


def embed_image(data: bytes, caption: str) -> str:
    """Make an HTML image that contains the bytes of a PNG."""
    from markupsafe import Markup

    source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    return Markup('<img src="{}" alt="{}">').format(source, caption)
