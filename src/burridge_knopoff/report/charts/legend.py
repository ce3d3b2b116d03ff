"""Legends: lists of the page, which wrap on a narrow screen and serve all charts of a section."""

from __future__ import annotations

from dataclasses import dataclass

from markupsafe import Markup

from burridge_knopoff.report.charts.theme import dark

_FORMS = {
    "circle": '<circle cx="7" cy="7" r="4.5"/>',
    "square": '<path d="M2.5 2.5h9v9h-9z"/>',
    "triangle-up": '<path d="M7 2l5.5 9.5h-11z"/>',
    "triangle-down": '<path d="M7 12l5.5-9.5h-11z"/>',
    "diamond": '<path d="M7 1l6 6-6 6-6-6z"/>',
    "cross": '<path d="M5 1h4v4h4v4h-4v4h-4v-4h-4v-4h4z"/>',
    "star": '<path d="M7 .5l2 4.3 4.6.5-3.4 3.2.9 4.7L7 10.8l-4.1 2.4.9-4.7L.4 5.3 5 4.8z"/>',
    "hexagon": '<path d="M7 1l5.2 3v6L7 13l-5.2-3V4z"/>',
    "pentagon": '<path d="M7 1l6 4.4-2.3 7H3.3L1 5.4z"/>',
    "x": '<path d="M4 1l3 3 3-3 3 3-3 3 3 3-3 3-3-3-3 3-3-3 3-3-3-3z"/>',
    "thin x": '<path d="M2.5 2.5l9 9m0-9l-9 9" fill="none" stroke-width="2"/>',
    "patch": '<path d="M1 1h12v12h-12z"/>',
    "line": '<path d="M0 7h14" stroke-width="2"/>',
    "dash": '<path d="M0 7h14" stroke-width="2" stroke-dasharray="5 3"/>',
    "dot": '<path d="M0 7h14" stroke-width="2" stroke-dasharray="2 2"/>',
}
_FORMS["hexagon2"] = _FORMS["hexagon"]


@dataclass(frozen=True)
class Entry:
    """An entry of a legend: name, form and colour of a mark; `edge` is the colour of its outline, if different."""

    name: str
    color: str
    form: str = "patch"
    edge: str = ""

    @property
    def mark(self) -> Markup:
        """The mark as SVG, in the colours of the theme."""
        shape = _FORMS[self.form.removesuffix("-open")]
        if self.form.endswith("-open"):
            shape = f'<g fill="none" stroke-width="1.5">{shape}</g>'
        fill, stroke = (f"light-dark({color}, {dark(color)})" for color in (self.color, self.edge or self.color))
        return Markup(
            f'<svg width="14" height="14" viewBox="0 0 14 14" aria-hidden="true" '
            f'style="fill: {fill}; stroke: {stroke}">{shape}</svg>'
        )
