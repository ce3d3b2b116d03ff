"""Sentences of summaries and verdicts as HTML: symbols with subscripts, names in backticks as code."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

_CODE = re.compile("`([^`]+)`")
# A single letter before the underscore: names such as one_sided are words.
_SUBSCRIPT = re.compile(r"\b([A-Za-zα-ωΑ-Ω])_(\w)(?!\w)")


def prose(sentence: str) -> Markup:
    """Convert a sentence to HTML, with everything else in it escaped."""
    html = _SUBSCRIPT.sub(r"\1<sub>\2</sub>", str(escape(sentence)))
    return Markup(_CODE.sub(r"<code>\1</code>", html))
