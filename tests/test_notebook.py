"""The notebook of the site is docs/tutorial.md; tests/test_tutorial.py checks its outputs."""

import runpy

import nbformat

from tests.pages import blocks


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
