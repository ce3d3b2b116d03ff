"""The programs of benchmarks/ and docs/ can be started: their imports exist."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PEERS = ("heyoka", "parso", "cosmic_ray", "sphinx")

START = """
import importlib, sys
from pathlib import Path
for path in map(Path, sys.argv[1:]):
    sys.path.insert(0, str(path.parent))
    try:
        importlib.import_module(path.stem)
    except ModuleNotFoundError as error:
        print(path.stem, error.name)
"""


@pytest.mark.slow
@pytest.mark.parametrize("folder", ["benchmarks", "docs"])
def test_every_program_finds_what_it_imports(folder):
    paths = map(str, sorted((ROOT / folder).glob("*.py")))
    process = subprocess.run([sys.executable, "-c", START, *paths], capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stderr
    assert [line for line in process.stdout.splitlines() if not line.endswith(PEERS)] == []
