"""The stub of the kernel's compiled module, with its docstrings.

`python -m tests.kernel.core_stub`, run in the root of the checkout, writes it next to the sources.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from burridge_knopoff.provenance.kernel_build import KERNEL

HEAD = "# Made by `python -m tests.kernel.core_stub`.\n"
STUB = KERNEL / "_core.pyi"


def core_stub(module: str = "burridge_knopoff.kernel._core") -> str:
    """Return the stub of a compiled module, in the project's style."""
    with TemporaryDirectory() as folder:
        path = Path(folder, STUB.name)
        # Values, such as the width of a vector, may differ between machines.
        stub = ["nanobind.stubgen", "--quiet", "--exclude-values", "--module", module, "--output-file", str(path)]
        styled = ["ruff", "format", "--isolated", "--quiet", "--line-length", "120", str(path)]
        for command in (stub, styled):
            subprocess.run([sys.executable, "-m", *command], check=True)
        return HEAD + path.read_text()


if __name__ == "__main__":
    STUB.write_text(core_stub())
