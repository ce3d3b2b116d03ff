"""Sentences of summaries and verdicts as HTML: symbols in italics, with subscripts, and names in backticks as code."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

_CODE = re.compile("`([^`]+)`")

# A single letter before the underscore: names such as one_sided are words.
_SUBSCRIPT = re.compile(r"\b([A-Za-zα-ωΑ-Ω])_(\w)(?!\w)")
_SYMBOL = re.compile(r"(?<![\w>])([JUVW]|[α-ω]|F(?=&#39;|\())(?![\w_])")
_PRIME = re.compile("(?<=</i>)&#39;")
# A line does not break at a sign of relation.
_BROKEN = re.compile(r"(?<=[\d>⟩]) (?=[=≤≥]|&[lg]t;)|(?<=[=≤≥]) |(?<=&[lg]t;) ")
_POWER = re.compile(r"\^(\w[\d.]*\d|\w)")
# The letters a, c, v and A are symbols in a formula; a is one after the words below, and before those further below.
_RELATION = r"(?:[=≤≥−+^/]|&lt;|&gt;)"
_BEFORE = (
    "every",
    "each",
    "any",
    "all",
    "same",
    "larger",
    "largest",
    "smaller",
    "smallest",
    "small",
    "parameter",
    "versus",
)
_AFTER = "with|at|for|from|of|where|located"
_IN_FORMULA = re.compile(
    "|".join(
        [
            rf"(?<![\w>])(?:[aAcv])(?= ?{_RELATION})",
            *(rf"(?<={sign} )(?:[acv])\b(?!\.\w)" for sign in ("[=≤≥]", "&lt;", "&gt;")),
            *(rf"(?<=\b{word} )a\b" for word in (*_BEFORE, "values of")),
            *(rf"(?<=\b{word} )a(?=[,.;:)]| (?:{_AFTER})\b|$)" for word in ("of", "in", "along", "against", "and")),
            "^a(?= at which)",
            r"(?<=\d )A\b",
            r"(?<=\()v(?=\))",
            r"(?<=\bfixed )v\b",
        ]
    )
)


def prose(sentence: str) -> Markup:
    """Convert a sentence to HTML, with everything else in it escaped."""
    parts = _CODE.split(str(escape(sentence)))
    # Every second part was in backticks.
    return Markup("".join(f"<code>{part}</code>" if n % 2 else _formulas(part) for n, part in enumerate(parts)))


def _formulas(html: str) -> str:
    html = _IN_FORMULA.sub(lambda found: f"<i>{found[0]}</i>", html)
    html = _SUBSCRIPT.sub(r"<i>\1</i><sub>\2</sub>", html)
    html = _PRIME.sub("′", _SYMBOL.sub(r"<i>\1</i>", html))
    html = _POWER.sub(r"<sup>\1</sup>", html)
    return _BROKEN.sub("\N{NO-BREAK SPACE}", html)
