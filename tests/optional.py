"""Optional programs that some tests use.

No test searches for a program: an environment variable names it. If the variable is not set, the test is skipped, and
the last lines of the run name both; if it names no program, the test fails.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Playwright

SETTINGS = {
    "BK_ARM64": "paths of a C++ compiler for arm64 and of an emulator, with a colon between them (Debian: "
    "g++-aarch64-linux-gnu, qemu-user)",
    "BK_CHROMIUM": "path of a Chromium (Debian: chromium)",
    "BK_CLANG": "path of clang++, or of several, with a colon between them (Debian: clang)",
    "BK_H5REPACK": "path of h5repack (Debian: hdf5-tools)",
    "BK_NCDUMP": "path of ncdump, with nccopy in its folder (Debian: netcdf-bin)",
    "BK_SLURM": "folders of the programs of Slurm and munge, for example /usr/bin:/usr/sbin (Debian: slurm-wlm, munge)",
}


def setting(name: str) -> str:
    """Return the value of the variable, empty if it is not set."""
    return os.environ.get(name, "")


def needs(name: str) -> pytest.MarkDecorator:
    """Return the mark of a test that is skipped unless the variable is set."""
    return pytest.mark.skipif(not setting(name), reason=f"{name} is not set: {SETTINGS[name]}")


def launch_chromium(playwright: Playwright) -> Browser:
    """Start the Chromium that the variable names; Debian's is a script, which calls other programs in its folder."""
    program = setting("BK_CHROMIUM")
    path = os.pathsep.join((os.environ["PATH"], str(Path(program).parent)))
    arguments = ["--no-sandbox", "--disable-gpu"]
    return playwright.chromium.launch(executable_path=program, args=arguments, env={**os.environ, "PATH": path})
