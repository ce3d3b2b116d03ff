"""The documentation site, built by Sphinx from the README, its pages and the docstrings: `make site`."""

from __future__ import annotations

import dataclasses
import inspect
import re
import shutil
from pathlib import Path

from docutils import nodes
from PIL import Image
from sphinx.application import Sphinx

import burridge_knopoff as library
from burridge_knopoff.model.fields import REQUIRED, fields_of

project = "burridge-knopoff"
release = library.__version__
html_title = f"{project} {release}"
html_theme = "furo"
html_copy_source = False
html_show_copyright = False
html_static_path = ["site.css"]
html_css_files = ["site.css"]
# The prime of a velocity is not a quotation mark.
smartquotes = False

# The pages stay where a code host shows them, so that relative links work in both places.
root_doc = "README"
include_patterns = ["*.md", "config/*.md", "docs/*.md"]
exclude_patterns = [".*", "build", "results"]
extensions = ["myst_parser", "sphinx.ext.autodoc"]
myst_heading_anchors = 4

add_module_names = False
autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
# The types of settings contain ranges and descriptions; `lay_out` lists these.
autodoc_typehints = "none"
default_role = "py:obj"

# Pixels of a figure as wide as a page.
FULL_WIDTH = 1400

ITEM = r"[a-zA-Z_][\w, ]* : "


def setup(app: Sphinx) -> None:
    """Register what Sphinx calls."""
    app.connect("source-read", complete)
    app.connect("doctree-read", scale)
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-process-docstring", lay_out)
    app.connect("build-finished", add_index)


def complete(app: Sphinx, page: str, source: list[str]) -> None:
    """Add a table of contents to the README, from its list of pages, and every public name to docs/api.md."""
    # A block that is a file has its path after the language, which no page shows.
    text = re.sub(r"^(```\w+) (\S+)$", r"`\2`\n\n\1", source[0], flags=re.MULTILINE)
    if page == root_doc:
        listed = text.split("## Documentation")[1].split("\n## ")[0]
        for caption, links in re.findall(r"^- ([\w, ]+): (.*(?:\n  .*)*)", listed, re.MULTILINE):
            pages = re.findall(r"\]\(([\w/]+)\.md\)", links)
            text += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(pages) + "\n```\n"
    elif page == "docs/api":
        for name in library.__all__:
            kind = "class" if inspect.isclass(getattr(library, name)) else "function"
            text += f"\n```{{eval-rst}}\n.. auto{kind}:: burridge_knopoff.{name}\n```\n"
    source[0] = text


def scale(app: Sphinx, page: nodes.document) -> None:
    """Give the figures of a page one scale, so that their letters are equally large."""
    for image in page.findall(nodes.image):
        # Pictures side by side share the width of their table.
        if not isinstance(image.parent.parent, nodes.section):
            continue
        with Image.open(Path(app.srcdir, image["uri"])) as picture:
            image["width"] = f"{min(100, round(100 * picture.width / FULL_WIDTH))}%"


def shorten(
    app: Sphinx, what: str, name: str, value: object, options: object, arguments: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Return a signature without the fields of settings that are a default value."""
    return arguments and re.sub(r"=(\w+)\((?:[^()]|\([^()]*\))*\)", r"=\1()", arguments), returned


def lay_out(app: Sphinx, what: str, name: str, value: object, options: object, lines: list[str]) -> None:
    """Turn a docstring into markup: lines `name : description` become a list, with all settings of a class added."""
    laid: list[str] = []
    example = False
    for line in lines:
        example = line.startswith(">>>") or (example and bool(line))
        first, *others = [line] if example else re.split(rf"; (?={ITEM})", line)
        if example:
            laid.append(first)
        elif re.match(ITEM, first):
            laid += entry(*first.split(" : ", 1))
        elif laid and laid[-1].startswith("    ") and first:
            laid += [f"    {markup(first.strip())}"] if first.startswith("    ") else ["", markup(first)]
        else:
            laid.append(markup(first))
        for other in others:
            laid += entry(*other.split(" : ", 1))
    if inspect.isclass(value) and dataclasses.is_dataclass(value):
        for key, field in fields_of(value).items():
            default = "" if field.default is REQUIRED else f"; default {field.default!r}"
            laid += entry(key, f"{field.description}: {field.range}{default}")
    lines[:] = [*laid, ""]


def entry(names: str, text: str) -> list[str]:
    """Return the lines of an entry of a list."""
    return ["", f"**{markup(names)}**", f"    {markup(text)}"]


def markup(text: str) -> str:
    """Return the markup of a text: names in backquotes become links, other backquotes code, the rest stays as it is."""
    parts = re.split(r"`([^`]+)`", text)
    parts[::2] = [re.sub(r"([*|_`\\])", r"\\\1", part) for part in parts[::2]]
    parts[1::2] = [f"`{part}`" if re.fullmatch(r"[\w.]+", part) else f"``{part}``" for part in parts[1::2]]
    return "".join(parts)


def add_index(app: Sphinx, error: Exception | None) -> None:
    """Copy the first page to index.html, the name that servers expect."""
    if error is None and app.builder.format == "html":
        shutil.copy(Path(app.outdir, f"{root_doc}.html"), Path(app.outdir, "index.html"))
