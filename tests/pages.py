"""Reads documentation pages, runs their Python blocks and compares the output that follows each block.

`python -m tests.pages docs/tutorial.md`, in the root of the checkout, runs a page and updates the output and pictures
of its blocks; --skip leaves out the blocks below a heading, --only runs only those.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import re
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^```(?P<info>[^\n`]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block: its info string, its text, the last heading before it, and where its text lies in the page."""

    info: str
    text: str
    heading: str
    span: tuple[int, int]


def blocks(page: str) -> list[Block]:
    """Return the fenced blocks of a page, in order."""
    code_blocks = []
    for match in FENCE.finditer(page):
        # A comment in a block is not a heading.
        before = FENCE.sub("", page[: match.start()])
        headings = re.findall(r"^#+ (.*)$", before, re.MULTILINE)
        code_blocks.append(Block(match["info"], match["text"], headings[-1] if headings else "", match.span("text")))
    return code_blocks


def claim_sections(root: Path) -> dict[str, str]:
    """Return {name of a claim: its section of docs/verdicts.md, as one line}."""
    parts = re.split(r"^#{3,} (.*)$", (root / "docs/verdicts.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    sections = dict(zip(parts[1::2], parts[2::2], strict=True))
    return {name: " ".join(text.split()) for name, text in sections.items() if re.fullmatch("[a-z0-9_]+", name)}


def apply(page: str, root: Path) -> list[str]:
    """Carry out the edits of a page in a tree and return the paths that they touch.

    A block `diff` names a file after --- and has hunks with @@ between them; the lines of a hunk that are not added
    must stand in the file exactly once. A block whose info string ends in a path is a new file.
    """
    touched = []
    for block in blocks(page):
        if block.info == "diff":
            name, *lines = block.text.splitlines()
            path = name.removeprefix("--- ")
            text = (root / path).read_text()
            for hunk in "\n".join(lines).split("\n@@\n"):
                before, after = (
                    "".join(f"{line[1:]}\n" for line in hunk.splitlines() if line[:1] != other) for other in "+-"
                )
                if text.count(before) != 1:
                    raise AssertionError(f"{path}: {text.count(before)} places, instead of one, for\n{before}")
                text = text.replace(before, after)
            (root / path).write_text(text)
        elif " " in block.info:
            path = block.info.split()[1]
            if (root / path).exists():
                raise AssertionError(f"{path}: is there already")
            (root / path).write_text(block.text)
        else:
            continue
        touched.append(path)
    return touched


def run(code: str, namespace: dict[str, object], place: str) -> str:
    """Run a block in a namespace and return what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, place, "exec"), namespace)
    return printed.getvalue()


def outputs(page: str, name: str, headings: set[str] | None = None) -> list[tuple[Block, str, str]]:
    """Run the Python blocks of a page in order, and return (output block, its text, what was printed) for each.

    headings : run only the blocks below these
    """
    code_blocks = blocks(page)
    namespace: dict[str, object] = {"__name__": "__main__"}
    results = []
    for number, block in enumerate(code_blocks):
        if block.info != "python" or (headings is not None and block.heading not in headings):
            continue
        printed = run(block.text, namespace, f"{name}, block {number + 1}")
        following = code_blocks[number + 1] if number + 1 < len(code_blocks) else None
        if following is not None and following.info == "text":
            results.append((following, following.text, printed))
        elif printed:
            raise AssertionError(f"{name}, block {number + 1} prints, and no block of text follows:\n{printed}")
    return results


def main() -> None:
    """Update the outputs of a page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path)
    parser.add_argument("--skip", action="append", default=[], metavar="HEADING")
    parser.add_argument("--only", action="append", default=[], metavar="HEADING")
    options = parser.parse_args()
    page = options.page.read_text()
    headings = set(options.only) or {block.heading for block in blocks(page)} - set(options.skip)
    for block, _, printed in reversed(outputs(page, str(options.page), headings)):
        page = page[: block.span[0]] + printed + page[block.span[1] :]
    options.page.write_text(page)


if __name__ == "__main__":
    main()
