"""The package as users install it: a source distribution, its wheel, and an environment with that wheel."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import venv
from dataclasses import dataclass
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.metadata import Distribution, distribution
from pathlib import Path

from packaging.requirements import Requirement

SDIST = "from setuptools import build_meta; build_meta.build_sdist('dist')"


@dataclass(frozen=True)
class Installation:
    """A folder with the distributions, in `dist`, and the environment."""

    folder: Path

    @property
    def python(self) -> str:
        """Path of its Python."""
        return str(self.folder / "environment" / "bin" / "python")

    @property
    def touched(self) -> list[str]:
        """Files of the tree that building the wheel has made, changed or deleted."""
        return json.loads((self.folder / "touched.json").read_text())

    @property
    def source(self) -> Path:
        """The source distribution."""
        return next((self.folder / "dist").glob("*.tar.gz"))

    @property
    def wheel(self) -> Path:
        """The wheel."""
        return next((self.folder / "dist").glob("*.whl"))


def install(repository: Path, folder: Path) -> None:
    """Build both distributions and install the wheel, without a network.

    The kernel is compiled for all vector widths and without optimization, which is quicker; tests/kernel/test_builds.py
    compares its numbers with those of the checkout.
    """
    tree = folder / "tree"
    compiled = shutil.ignore_patterns("*.so", "build.json", "*.egg-info", "__pycache__")
    shutil.copytree(repository / "src", tree / "src", ignore=compiled)
    for path in repository.iterdir():
        if path.is_file() and not path.name.startswith("."):
            shutil.copy(path, tree)
    subprocess.run([sys.executable, "-c", SDIST], cwd=tree, check=True, capture_output=True)
    shutil.move(tree / "dist", folder / "dist")
    shutil.rmtree(tree)

    installation = Installation(folder)
    # A command, since the `tarfile` of Python 3.11.2 (Debian 12) has no filters.
    subprocess.run(
        [sys.executable, "-m", "tarfile", "-e", str(installation.source), str(folder / "unpacked")], check=True
    )
    (unpacked,) = (folder / "unpacked").iterdir()
    flags = unpacked / "src" / "burridge_knopoff" / "provenance" / "compilation.py"
    assert '"-O3"' in flags.read_text()
    flags.write_text(flags.read_text().replace('"-O3"', '"-O0"'))
    # As in a checkout whose own kernel may be in use.
    for name in ("build.json", f"_core{EXTENSION_SUFFIXES[0]}"):
        (unpacked / "src" / "burridge_knopoff" / "kernel" / name).write_text("of the tree\n")
    before = content_of(unpacked)
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    offline = ["--no-index", "--no-deps"]
    subprocess.run(
        [*pip, "wheel", "--no-build-isolation", *offline, "--wheel-dir", str(folder / "dist"), str(unpacked)],
        env={**os.environ, "BURRIDGE_KNOPOFF_LANES": "all"},
        check=True,
    )
    after = content_of(unpacked)
    touched = sorted(name for name in {**before, **after} if before.get(name) != after.get(name))
    (folder / "touched.json").write_text(json.dumps(touched))
    shutil.rmtree(folder / "unpacked")

    environment = folder / "environment"
    venv.create(environment, symlinks=True)
    subprocess.run([*pip, "--python", installation.python, "install", *offline, str(installation.wheel)], check=True)
    (packages,) = environment.glob("lib/python*/site-packages")
    (information,) = packages.glob("*.dist-info")
    for needed in _needs(Distribution.at(information)).values():
        for name in {file.parts[0] for file in needed.files or ()} - {"..", "__pycache__"}:
            (packages / name).symlink_to(str(needed.locate_file(name)))


def content_of(tree: Path) -> dict[str, tuple[int, bytes]]:
    """Return {name: time of the last change, content} of all files and folders in a tree."""
    return {
        str(path.relative_to(tree)): (path.stat().st_mtime_ns, path.read_bytes() if path.is_file() else b"")
        for path in tree.rglob("*")
    }


def _needs(package: Distribution) -> dict[str, Distribution]:
    """Return all requirements of a distribution without extras, and theirs, as installed here."""
    distributions: dict[str, Distribution] = {}
    waiting = [package]
    while waiting:
        for line in waiting.pop().requires or ():
            requirement = Requirement(line)
            wanted = requirement.marker is None or requirement.marker.evaluate({"extra": ""})
            if wanted and requirement.name not in distributions:
                distributions[requirement.name] = distribution(requirement.name)
                waiting.append(distributions[requirement.name])
    return distributions
