"""The figures of a study as pictures inside the page."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from burridge_knopoff.figures.description import title_and_caption
from burridge_knopoff.provenance.bad_file import BadFile


@dataclass(frozen=True)
class Picture:
    """A figure in the page: `data` is a data URI, sizes are in pixels."""

    name: str
    title: str
    caption: str
    data: str
    width: int
    height: int


def read_picture(path: str | Path, has_paper_chain: bool) -> Picture:
    """Read a figure and convert it at full size to 256 colours, which takes a quarter of the size of its file.

    The effort balances size and time: more would save a few per cent in several times the time.

    Raises BadFile if the file is not a picture, ValueError if no figure has its name.
    """
    name = Path(path).stem
    try:
        # Pillow would start another program for a picture in PostScript.
        with Image.open(path, formats=["PNG"]) as opened:
            colors = opened.convert("RGB").quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    except (OSError, SyntaxError) as error:
        raise BadFile(path, f"is not a readable picture ({error})") from None
    title, caption = title_and_caption(name, has_paper_chain)
    content = io.BytesIO()
    colors.convert("RGB").save(content, "WEBP", lossless=True, quality=40, method=3)
    data = "data:image/webp;base64," + base64.b64encode(content.getvalue()).decode()
    return Picture(name, title, caption, data, *colors.size)
