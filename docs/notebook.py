"""Write docs/tutorial.md as a notebook: python docs/notebook.py FILE.

Nothing is run: each cell gets the output and the picture from the page, where tests check them.
"""

from __future__ import annotations

import base64
import re
import sys
from pathlib import Path

import nbformat
from nbformat import v4

PAGE = Path(__file__).parent / "tutorial.md"

# A block of code with what it prints, or a picture.
CELL = re.compile(
    r"^```python\n(?P<code>.*?)\n```\n(?:\n```text\n(?P<printed>.*?)^```\n)?|^!\[(?P<title>[^\n]*)\]\((?P<picture>[^\n]*)\)\n",
    re.MULTILINE | re.DOTALL,
)
START = """\
# Everything runs in the root of the checkout.
import os
from pathlib import Path

from IPython.display import Image

os.chdir(next(folder for folder in (Path.cwd(), *Path.cwd().parents) if (folder / "docs" / "tutorial.md").exists()))"""


def notebook() -> str:
    """Return the text of the notebook."""
    page = PAGE.read_text(encoding="utf-8")
    nb = v4.new_notebook(metadata={"kernelspec": {"name": "python3", "display_name": "Python 3"}})
    end = 0
    for match in CELL.finditer(page):
        if text := page[end : match.start()].strip():
            nb.cells.append(v4.new_markdown_cell(text))
        if end == 0:
            nb.cells.append(v4.new_code_cell(START))
        nb.cells.append(picture(match) if match["picture"] else block(match))
        end = match.end()
    for number, cell in enumerate(nb.cells, start=1):
        # nbformat assigns random ids.
        cell.id = f"cell-{number}"
    for count, cell in enumerate((cell for cell in nb.cells if cell.cell_type == "code"), start=1):
        for part in (cell, *cell.outputs):
            if "execution_count" in part:
                part.execution_count = count
    return nbformat.writes(nb) + "\n"


def block(match: re.Match[str]) -> nbformat.NotebookNode:
    """Return a cell of code with what it prints."""
    printed = [v4.new_output("stream", text=match["printed"])] if match["printed"] else []
    return v4.new_code_cell(match["code"], outputs=printed)


def picture(match: re.Match[str]) -> nbformat.NotebookNode:
    """Return a cell that shows a picture file."""
    path = PAGE.parent / match["picture"]
    bundle = {"image/png": base64.b64encode(path.read_bytes()).decode(), "text/plain": match["title"]}
    code = f'Image("{path.relative_to(PAGE.parents[1])}")'
    return v4.new_code_cell(code, outputs=[v4.new_output("execute_result", data=bundle, execution_count=1)])


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(notebook(), encoding="utf-8")
