"""Sentences of summaries and verdicts as HTML: symbols in italics, with subscripts, and names in backticks as code."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

from burridge_knopoff.report.numbers import with_powers_of_ten

_CODE = re.compile("`([^`]+)`")

# A single letter before the underscore: names such as one_sided are words.
_SUBSCRIPT = re.compile(r"\b([A-Za-zα-ωΑ-Ω])_(\w)(?!\w)")
_INDEX = re.compile(r"<sub>([iN])</sub>")
_SYMBOL = re.compile(r"(?<![\w>])([FJNTUVWkv]|[α-ω]|aU|av|vτ)(?![\w_]|\.\w)")
_PRIME = re.compile("(?<=</i>)&#39;|(?<=</sub>)&#39;")
_MEAN = re.compile("&lt;J&gt;")
# A line does not break at a sign of relation, at one of an error, or before a per cent sign.
_BROKEN = re.compile(r"(?<=[\d>⟩]) (?=[=≤≥±%]|&[lg]t;)|(?<=[=≤≥±]) |(?<=&[lg]t;) ")
_POWER = re.compile(r"\^(\w[\d.]*\d|\w)")
# The letters a, c and A are symbols in a formula; a is one after the words below, and before those further below.
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
    "rising",
    "falling",
    "parameter",
    "versus",
)
_AFTER = "with|at|for|from|of|where|located"
_IN_FORMULA = re.compile(
    "|".join(
        [
            rf"(?<![\w>])(?:[aAc])(?= ?{_RELATION})",
            *(rf"(?<={sign} )(?:[ac])\b(?!\.\w)" for sign in ("[=≤≥]", "&lt;", "&gt;")),
            *(rf"(?<=\b{word} )a\b" for word in (*_BEFORE, "values of", "value of")),
            *(rf"(?<=\b{word} )a(?=[,.;:)]| (?:{_AFTER})\b|$)" for word in ("of", "in", "along", "against", "and")),
            *(rf"(?<=\b{word} )a(?=[,.;:)]| between\b|$)" for word in ("for", "with")),
            r"(?<=, )a(?=\))",
            "(?<=while )a(?= is raised)",
            "^a(?= at which)",
            *(rf"(?<={word} )A\b" for word in (r"\d", "amplitude", "of")),
        ]
    )
)


def prose(sentence: str) -> Markup:
    """Convert a sentence to HTML, with everything else in it escaped."""
    parts = _CODE.split(str(escape(sentence)))
    # Every second part was in backticks.
    return Markup("".join(f"<code>{part}</code>" if n % 2 else _formulas(part) for n, part in enumerate(parts)))


def _formulas(html: str) -> str:
    # The name of a convention in the config is a word of prose.
    html = html.replace("one_sided", "one-sided")
    html = _IN_FORMULA.sub(lambda match: f"<i>{match[0]}</i>", html)
    html = _SUBSCRIPT.sub(r"<i>\1</i><sub>\2</sub>", _MEAN.sub("⟨J⟩", html))
    html = _INDEX.sub(r"<sub><i>\1</i></sub>", html)
    html = _PRIME.sub("′", _SYMBOL.sub(r"<i>\1</i>", html))
    html = with_powers_of_ten(_POWER.sub(r"<sup>\1</sup>", html))
    return _BROKEN.sub("\N{NO-BREAK SPACE}", html)
