"""Reports as self-contained HTML files."""

from __future__ import annotations

import base64
from pathlib import Path

import jinja2

from ..support.output_files import atomic_write, encode_text


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
        loader=jinja2.FileSystemLoader(str(Path(__file__).parent / "templates")),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["image"] = embed_image
    return environment.get_template(template).render(values)


def embed_image(data: bytes, caption: str) -> str:
    """Make an HTML image that contains the bytes of a PNG."""
    from markupsafe import Markup

    source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
    return Markup('<img src="{}" alt="{}">').format(source, caption)
