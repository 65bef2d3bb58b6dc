"""Reports as self-contained HTML files."""

from __future__ import annotations

import base64
import re
from pathlib import Path
from typing import List, Match, Union

import jinja2

from ..support.input_files import is_file
from ..support.output_files import atomic_write, encode_text
from .drawing import Drawing
from .packing import compress
from .run_record import describe_command

_FOLDER = Path(__file__).parent
_BUNDLE = _FOLDER / "bundle"  # scripts/bundle_player writes it
_PARTS = ("player.js", "player.css", "LICENSE.player")
_PLAYER = '<section class="quadcore-player"'


def write_page(path: Path, template: str, **values: object) -> None:
    """Fill in a template and write the page; see `render`.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    page = _add_contents(render(template, run=describe_command(), **values))
    with atomic_write(path) as stream:
        stream.write(encode_text(page))


def render(template: str, **values: object) -> str:
    """Fill in a template.

    Parameters
    ----------
    template
        Name of a file in ``templates/``; pages extend ``page.html``. The filter ``image`` embeds a
        `Drawing` or a PNG: ``{{ drawing | image("name") }}``.
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
    environment.filters["image"] = embed_figure
    text = environment.get_template(template).render({"run": {}, "conditions": "", **values})
    return _add_player(text) if _PLAYER in text and "</body>" in text else text


def has_player() -> bool:
    """Return whether this build of the package contains the script of the player."""
    return all(is_file(_BUNDLE / name) for name in _PARTS)


def _add_player(page: str) -> str:
    """Add the script, the style and the licences of the player, once for all players of a page."""
    script, style, licences = ((_BUNDLE / name).read_text(encoding="utf-8") for name in _PARTS)
    end = render("player_script.html", script=compress(script.encode()), licences=licences)
    head, _, body = page.partition("</head>")
    body, _, rest = body.rpartition("</body>")
    return f"{head}<style>\n{style}</style>\n</head>{body}{end}\n</body>{rest}"


def _add_contents(page: str) -> str:
    """Add an anchor to each heading of a page, and list the headings at its top."""
    titles: List[str] = []

    def add_anchor(heading: Match[str]) -> str:
        titles.append(re.sub(r"<[^>]*>", "", heading.group(1)))
        return f'<h2 id="section-{len(titles)}">{heading.group(1)}</h2>'

    page = re.sub(r"<h2>(.*?)</h2>", add_anchor, page, flags=re.DOTALL)
    links = [f'<a href="#section-{i}">{title}</a>' for i, title in enumerate(titles, start=1)]
    contents = f'<nav aria-label="contents">{" ".join(links)}</nav>' if len(links) > 1 else ""
    return page.replace("<!-- contents -->", contents, 1)


def embed_figure(drawing: Union[Drawing, bytes], name: str) -> str:
    """Make an HTML figure of a drawing, or of the bytes of a PNG, with buttons that save it."""
    from markupsafe import Markup

    if isinstance(drawing, bytes):
        return embed_image(drawing, name)
    title = drawing.title or name
    svg = drawing.svg.replace("<svg", Markup('<svg role="img" aria-label="{}"').format(title), 1)
    links = Markup(
        '<button type="button" class="save-svg" data-name="{}">Save SVG</button>'
    ).format(name)
    if "pdf" in drawing.files:
        source = f"data:application/pdf;base64,{base64.b64encode(drawing.files['pdf']).decode()}"
        links += Markup(' <a download="{}.pdf" href="{}">PDF</a>').format(name, source)
    return Markup('<figure class="plot">{}<figcaption>{}</figcaption></figure>').format(
        Markup(svg), links
    )


def embed_image(data: bytes, caption: str) -> str:
    """Make an HTML image that contains the bytes of a PNG."""
    from markupsafe import Markup

    source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    return Markup('<img class="plot" src="{}" alt="{}">').format(source, caption)
