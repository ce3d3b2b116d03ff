"""The common look of the figures, and writing them to files."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import partial, wraps
from io import BytesIO
from pathlib import Path
from typing import Any, ParamSpec

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase, get_registered_canvas_class
from matplotlib.container import Container, ErrorbarContainer
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D

from burridge_knopoff.provenance.files import write_whole

Arguments = ParamSpec("Arguments")

#: Width of two journal columns and of one, 17.8 and 8.6 cm, in inches.
PAGE = 7.0
COLUMN = 3.4

# Dots per inch on a screen.
SCREEN = 144

# Largest number of panels side by side, where each initial state has a panel.
ACROSS = 3

#: Most entries of a legend.
MOST_ENTRIES = 8

# Typical number of letters of a title in an inch.
LETTERS = 17

# Complete, so that a user's own settings have no effect. Only the choice of a backend stays the user's.
STYLE: Any = {
    **{key: value for key, value in mpl.rcParamsDefault.items() if key != "backend"},
    "font.family": "serif",
    "font.serif": ["STIXGeneral"],
    "mathtext.fontset": "stix",
    "font.size": 9.0,
    "axes.titlesize": 9.0,
    "axes.linewidth": 0.7,
    "axes.grid": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "lines.linewidth": 1.0,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "savefig.dpi": 300,
    "pdf.fonttype": 42,
}


class StyledFigure(Figure):
    """A figure that is drawn in the common look wherever a user shows or saves it."""

    def draw(self, renderer: RendererBase) -> None:
        """Draw the figure."""
        # Ticks, among others, are created only now.
        with mpl.rc_context(STYLE):
            super().draw(renderer)

    def _repr_png_(self) -> bytes:
        """Return the picture as a notebook shows it, which shows none by itself until pyplot is imported."""
        picture = BytesIO()
        self.savefig(picture, format="png", dpi=SCREEN)
        return picture.getvalue()


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Decorate a function to draw its figure in the common look, whatever the caller's own settings."""

    @wraps(draw)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Figure:
        with mpl.rc_context(STYLE):
            return draw(*args, **kwargs)

    return wrapper


def new_figure(
    width: float,
    height: float,
    rows: int = 1,
    columns: int = 1,
    share_rows: bool = True,
    share_columns: bool = True,
    empty: Collection[int] = (),
) -> tuple[Figure, list[Axes]]:
    """Return a figure of a size in inches and its panels, row by row; columns may share x, and rows may share y.

    empty : places without a panel, counted row by row
    """
    # Wide enough that the last tick label of a panel stays apart from the first of the next panel.
    figure = StyledFigure(figsize=(width, height), layout=ConstrainedLayoutEngine(wspace=0.04))
    axes = figure.subplots(
        rows,
        columns,
        sharex="col" if share_columns else False,
        sharey="row" if share_rows else False,
        squeeze=False,
    )
    for place in empty:
        axes.flat[place].remove()
    # A panel removed later would stay in the alignment, and the figure could not be drawn.
    figure.align_ylabels()
    return figure, [panel for place, panel in enumerate(axes.flat) if place not in empty]


def page_width(columns: int) -> float:
    """Return the width in inches of a figure with `columns` columns: a page for up to three, in proportion for more."""
    return PAGE * max(1.0, columns / 3)


def panel_table(
    height: float, columns: int, x: str, ys: Sequence[str], share_y: bool = True
) -> tuple[Figure, np.ndarray]:
    """Return a figure and its panels, shape (len(ys), columns); a row that does not fit continues in the next line.

    One or two panels stand one above the other, in the width of a journal column.

    height : of a panel in inches, with its title
    x, ys : axis labels: one for all columns, and one for each row
    """
    narrow = columns * len(ys) <= 2
    across = 1 if narrow else min(columns, ACROSS)
    lines = -(-columns // across)
    count = len(ys) * lines
    empty = np.arange(count * across).reshape(len(ys), -1)[:, columns:].ravel().tolist()
    width = COLUMN if narrow else page_width(across)
    figure, panels = new_figure(width, 0.6 + height * count, count, across, share_rows=False, empty=empty)
    table = np.reshape(np.array(panels, dtype=object), (len(ys), columns))
    for row, y in zip(table, ys, strict=True):
        for number, panel in enumerate(row):
            if number % across == 0:
                panel.set_ylabel(y)
            elif share_y:
                panel.tick_params(which="both", labelleft=False)
            if share_y and number:
                panel.sharey(row[0])
    for panel in table[-1, -across:]:
        panel.set_xlabel(x)
        panel.tick_params(labelbottom=True)
    return figure, table


def begin_at_zero(panel: Axes) -> None:
    """Scale the y axis of a row of panels from just below 0 to just above its largest value."""
    tops = [axes.dataLim.y1 for axes in panel.get_shared_y_axes().get_siblings(panel)]
    top = max(filter(np.isfinite, tops), default=0.0)
    # Without this, rounding would set the scale where all values are 0.
    top = top if top > 1e-9 else 0.01
    panel.set_ylim(-0.03 * top, 1.1 * top)


def scale_to_decades(panel: Axes) -> None:
    """Scale the logarithmic y axis of a row of panels between powers of ten, so that only these have tick labels."""
    rows = [axes.dataLim for axes in panel.get_shared_y_axes().get_siblings(panel)]
    low, high = min(row.minposy for row in rows), max(row.y1 for row in rows)
    if 0.0 < low <= high < np.inf:
        first, last = np.floor(np.log10(low)), np.ceil(np.log10(high))
        panel.set_ylim(0.7 * 10.0**first, 1.4 * 10.0 ** max(last, first + 1))


def label_panels(axes: Iterable[Axes], titles: Iterable[str], letters: int = LETTERS) -> None:
    """Write (a), (b), … and a title above each panel, in as many lines as needed; no letter for a single panel.

    letters : number of letters of a title for each inch of a panel
    """
    panels = list(axes)
    for number, (panel, title) in enumerate(zip(panels, titles, strict=True)):
        letter = "(" + chr(ord("a") + number % 26) * (number // 26 + 1) + ") " if len(panels) > 1 else ""
        place, figure = panel.get_subplotspec(), panel.get_figure(root=True)
        share = len(place.colspan) / place.get_gridspec().ncols if place is not None else 1.0
        width = share * figure.get_figwidth() if figure is not None else PAGE
        panel.set_title(_wrapped(f"{letter}{title}", round(letters * width)), loc="left")


def legend_entries(panels: Iterable[Axes]) -> tuple[list[Artist], list[str]]:
    """Return the handles and labels of everything with a point in some panel, each label once."""
    entries: dict[str, Artist] = {}
    for panel in panels:
        (left, right), (bottom, top) = panel.get_xlim(), panel.get_ylim()
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            line: Any = handle[0] if isinstance(handle, ErrorbarContainer) else handle
            x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
            if ((x >= left) & (x <= right) & (y >= bottom) & (y <= top)).any():
                entries.setdefault(label, handle)
    return list(entries.values()), list(entries)


class SideBySide(Container):
    """An entry of a legend that shows several artists side by side."""


Legend.update_default_handler_map({SideBySide: HandlerTuple(ndivide=None)})


def legend_below(figure: Figure | SubFigure, *groups: Sequence[Artist]) -> None:
    """Put a legend below all panels, in as few rows as fit into the width of the figure, of about equal length.

    groups : handles; each group begins a row
    """
    filled = [group for group in groups if group]
    longest = max(map(len, filled), default=0)
    for rows in range(1, longest + 1):
        columns = -(-longest // rows)
        handles = [handle for group in filled for handle in _padded(group, columns if len(filled) > 1 else 1)]
        # Matplotlib fills columns; the legend is read by rows.
        in_rows = [handle for first in range(columns) for handle in handles[first::columns]]
        legend = figure.legend(handles=in_rows, loc="outside lower center", ncols=columns)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return
        legend.remove()


def legend_inside(panel: Axes, handles: Sequence[Artist]) -> None:
    """Put a small legend where it covers the least of a panel, in a frame that tells its symbols from points."""
    if handles:
        look: Any = {"frameon": True, "fancybox": False, "edgecolor": "0.7", "fontsize": 7.0, "handlelength": 1.5}
        panel.legend(handles=handles, loc="best", **look).get_frame().set_linewidth(0.5)


def _padded(handles: Sequence[Artist], columns: int) -> list[Artist]:
    """Return handles of a legend with empty ones at the end, which fill the last row."""
    return [*handles, *(Line2D([], [], linestyle="", label=" ") for _ in range(-len(handles) % columns))]


def _wrapped(title: str, letters: int) -> str:
    """Break a title into lines of a length, but no formula, which is half commands, and no name with its number."""
    lines = [""]
    length = 0
    for word in re.findall(r"(?<=, )(?:[^ ,$]+ ){1,3}[-+.\de]+,?(?= |$)|(?:\$[^$]*\$|[^ $])+", title):
        size = len(re.sub(r"\$[^$]*\$", lambda formula: formula[0][: len(formula[0]) // 2], word))
        if lines[-1] and length + 1 + size > letters:
            lines.append("")
            length = 0
        lines[-1] += f" {word}" if lines[-1] else word
        length += 1 + size
    return "\n".join(lines)


def even_indices(count: int, most: int) -> np.ndarray:
    """Return the places of at most so many of `count` items, evenly spaced, with the first and the last."""
    return np.unique(np.linspace(0, count - 1, min(most, count)).round().astype(int))


def lone_marker(values: np.ndarray) -> str:
    """Return the marker of a curve: none, unless it has a single point, which a line would not show."""
    return "o" if len(values) == 1 else ""


def say(panel: Axes, words: str) -> None:
    """Write words into the middle of a panel."""
    panel.text(0.5, 0.5, words, ha="center", transform=panel.transAxes)


def say_nothing(panel: Axes, reason: str) -> None:
    """Replace the axes of a panel by the reason for its being empty."""
    say(panel, reason)
    panel.set_axis_off()


def write_figure(figure: Figure, *paths: str | Path, origins: Mapping[Path, Mapping[str, Any]] | None = None) -> None:
    """Write a figure in the format of each path (.pdf, .png or .svg); the same figure gives the same bytes.

    origins : {path: origin of the file, as a mapping}, if it belongs to a study; PNG files contain it
    """
    for path in map(Path, paths):
        # `savefig` would draw twice, first for the layout alone, which any drawing starts with.
        canvas = get_registered_canvas_class(path.suffix[1:])
        metadata: dict[str, str | None] = {}
        if path.suffix == ".pdf":
            # Without this, PDF files record the time.
            metadata = {"CreationDate": None}
        elif path.suffix == ".png" and origins:
            metadata = {"origin": json.dumps(origins[path])}
        with mpl.rc_context(STYLE):
            figure.dpi = STYLE["savefig.dpi"]
            draw = getattr(canvas(figure), f"print_{path.suffix[1:]}")
            write_whole(path, partial(draw, metadata=metadata))
        # Keep the layout found for the first file: finding it takes as long as drawing.
        figure.set_layout_engine("none")
