"""Pictures look the same whatever a user's own settings of matplotlib are."""

import os
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import to_dataset, write_point
from burridge_knopoff.figures import motion
from burridge_knopoff.figures.style import write_figure

#: What a user may have in a matplotlibrc.
OWN = {
    "text.usetex": True,
    "font.family": "fantasy",
    "axes.spines.top": False,
    "axes.grid": True,
    "axes.facecolor": "yellow",
    "axes.formatter.use_locale": True,
    "axes.labelpad": 20.0,
    "axes.unicode_minus": False,
    "errorbar.capsize": 9.0,
    "figure.autolayout": True,
    "figure.dpi": 37,
    "figure.facecolor": "black",
    "figure.constrained_layout.h_pad": 0.5,
    "image.cmap": "jet",
    "legend.loc": "center",
    "lines.marker": "x",
    "path.sketch": (1, 100, 2),
    "pdf.compression": 0,
    "savefig.bbox": "tight",
    "savefig.facecolor": "black",
    "savefig.transparent": True,
    "svg.fonttype": "none",
    "text.color": "green",
    "xtick.labelsize": 20,
    "ytick.minor.visible": True,
}


@pytest.fixture(scope="module")
def run():
    return simulate(Model("linearized", a=0.08), "plus", transient=50.0, window=50.0, batches=2)


@pytest.mark.slow
def test_pictures_have_the_same_bytes(run, tmp_path):
    point = to_dataset(run)
    for name, settings in (("plain", {}), ("own", OWN)):
        with mpl.rc_context(settings):
            paths = [tmp_path / f"{name}.{suffix}" for suffix in ("png", "pdf", "svg")]
            write_figure(motion.draw({"plus": point}), *paths)
    for suffix in ("png", "pdf"):
        assert (tmp_path / f"plain.{suffix}").read_bytes() == (tmp_path / f"own.{suffix}").read_bytes(), suffix


@pytest.mark.slow
def test_figures_in_a_notebook_look_the_same(run):
    """They are drawn later, under the settings of the notebook."""
    drawn = []
    events = run.catalogue(200.0)
    for settings in ({}, OWN):
        with mpl.rc_context(settings):
            for figure in (run.plot(), events.plot()):
                canvas = FigureCanvasAgg(figure)
                canvas.draw()
                drawn.append(np.asarray(canvas.buffer_rgba()).copy())
    plain, settings = drawn[:2], drawn[2:]
    assert all(np.array_equal(*pair) for pair in zip(plain, settings, strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["module://matplotlib_inline.backend_inline", "none_such"])
def test_a_backend_that_is_not_installed(backend, run, tmp_path):
    """As a notebook of another environment hands it to the programs that it starts."""
    bk = Path(sys.executable).parent / "bk"
    write_point(run, tmp_path / "run.nc")
    command, environment = [bk, "show", "run.nc", "--plot", "run.png"], {**os.environ, "MPLBACKEND": backend}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "run.png").stat().st_size > 5_000
