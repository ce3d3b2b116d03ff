"""The notebook of the site is docs/tutorial.md; tests/test_tutorial.py checks its outputs."""

import runpy
import sys
from types import SimpleNamespace

import nbformat
from matplotlib.figure import Figure

from tests.pages import blocks, run
from tests.test_tutorial import SLIDER


def test_the_notebook_is_that_of_the_page(repository):
    module = runpy.run_path(str(repository / "docs" / "notebook.py"))
    text = module["notebook"]()
    nbformat.validate(notebook := nbformat.reads(text, as_version=4))
    cells = notebook.cells
    page = blocks(module["PAGE"].read_text())
    codes = [cell for cell in cells if cell.cell_type == "code"]
    sources = [f"{cell.source}\n" for cell in codes[1:] if not cell.source.startswith("Image(")]
    assert [block.text for block in page if block.info == "python"] == sources
    printed = [output.text for cell in codes for output in cell.outputs if output.output_type == "stream"]
    assert [block.text for block in page if block.info == "text"] == printed
    assert sum("image/png" in output.get("data", {}) for cell in codes for output in cell.outputs) == 3


def test_sliders_move_pictures(repository, monkeypatch):
    """At both ends of each slider, the picture is that of its a."""
    drawn = []

    def interact(**widgets):
        def decorate(function):
            for a in (widgets["a"].min, widgets["a"].max):
                others = {name: choices[-1] for name, choices in widgets.items() if name != "a"}
                drawn.append((a, function(a=a, **others)))
            return function

        return decorate

    def slider(value, **options):
        return SimpleNamespace(value=value, **options)

    monkeypatch.setitem(sys.modules, "ipywidgets", SimpleNamespace(interact=interact, FloatSlider=slider))
    namespace = {}
    for block in blocks((repository / "docs" / "tutorial.md").read_text()):
        if block.heading == SLIDER:
            assert not run(block.text, namespace, SLIDER)
    assert len(drawn) == 4
    for a, figure in drawn:
        assert isinstance(figure, Figure)
        assert f"$a={a:g}$" in figure.axes[0].get_title(loc="left")
