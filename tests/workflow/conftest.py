"""The real Snakefile on a small study in a temporary folder."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import made_once
from tests.workflow.snakemake import run_snakemake

REPOSITORY = Path(__file__).parent.parent.parent

TINY = """
study: tiny
a: [0.05, 0.08, {from: 0.2, to: 0.22, step: 0.02}]
initial: {minus: {}, plus: {}}
transient: 100
window: 200
batches: 4
attractors: {samples: 6, fraction_width: 0.3, lifetime: 1000, transient: 500, window: 500, time_limit: 5000,
  perturbations: 4}
refine: {resolution: 1}
basins: {pixels: 8, pairs: 20}
phases: {a: [0.05, 0.08], amplitude: [0.03, 0.3], phase_difference: [20, 180], inner_share: [0, 0.2], samples: 3}
solvers: {a: [0.2], step: 0.01}
chains: {two_blocks: {a: [0.02, 0.15], samples: 2}}
"""

#: A small study with points that do not complete: at a = 2.5 the linearized law accelerates blocks without limit.
#: Stages
#: that no test needs are left out.
LIMITS = """
study: limits
a: [0.05, 2.5]
initial: {minus: {}, plus: {}}
transient: 30
window: 60
batches: 2
lyapunov_alignment: 10
attractors: {samples: 2, fraction_width: 0.4, lifetime: 1000, transient: 300, window: 300, time_limit: 1000,
  perturbations: 4}
refine: {resolution: 1}
basins: {a: {linearized: [], nonlinear: [0.05]}, pixels: 2, pairs: 2, tiles: 1}
solvers: {a: [2.5], step: 0.01}
chains: {two_blocks: {a: [0.02], samples: 1}}
without: [proof, bifurcations, phases]
"""


class Study:
    """A folder in which Snakemake runs a config through the Snakefile, and with the package, of a checkout."""

    def __init__(self, folder: Path, config: str = TINY, repository: Path = REPOSITORY) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self.config = folder / "study.yaml"
        self.config.write_text(config)
        self.repository = repository
        self.output = ""

    def command(self, *arguments: str, cores: int = 2) -> list[str]:
        """Return the command line; arguments follow the usual ones."""
        snakemake = str(Path(sys.executable).parent / "snakemake")
        return [
            *(snakemake, f"-c{cores}", "-s", str(self.repository / "Snakefile")),
            *("--configfile", str(self.config), "--nocolor", *arguments),
        ]

    def run(self, *arguments: str, cores: int = 2) -> subprocess.CompletedProcess[str]:
        """Run Snakemake to its end; standard output and error are captured."""
        return run_snakemake(self.command(*arguments, cores=cores), self.folder, self.environment())

    def environment(self) -> dict[str, str]:
        """Return the environment of its commands: the package is that of its repository."""
        inherited = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
        path = [str(self.repository / "src"), *filter(None, [inherited.get("PYTHONPATH")])]
        return {**inherited, "PYTHONPATH": os.pathsep.join(path)}

    def ok(self, *arguments: str, cores: int = 2) -> str:
        """Run Snakemake, require success, and return all that it wrote."""
        run = self.run(*arguments, cores=cores)
        assert run.returncode == 0, run.stderr
        return run.stdout + run.stderr

    def files(self, *folders: str) -> dict[str, bytes]:
        """Return {path below results/<study>: bytes} of the results in these folders."""
        results = next((self.folder / "results").iterdir())
        return {
            str(path.relative_to(results)): path.read_bytes()
            for folder in folders
            for path in sorted((results / folder).rglob("*"))
            if path.is_file() and not path.name.startswith(".")
        }


def snakemake_of_checkout(folder: Path) -> str:
    """Return the beginning of a command that continues a study in a folder by the Snakefile of this checkout."""
    checkout = os.path.relpath(REPOSITORY, folder.resolve())
    return f"snakemake -c2 -s {checkout}/Snakefile --workflow-profile {checkout}/profiles/default"


def run_once(factory: pytest.TempPathFactory, name: str, config: str) -> Study:
    """Return a study that has run to its end, once for all workers, with its `output`."""
    source = made_once(
        factory, name, lambda folder: (folder / "output").write_text(Study(folder / "study", config).ok())
    )
    # Snakemake locks its folder: each worker has a copy.
    study = copied(source / "study", factory.mktemp(name) / "study")
    study.output = (source / "output").read_text()
    return study


def copied(study: Path, folder: Path, repository: Path = REPOSITORY) -> Study:
    """Return a copy of a study to damage and rerun; modification times are kept."""
    subprocess.run(["cp", "-a", str(study), str(folder)], check=True)
    return Study(folder, (study / "study.yaml").read_text(), repository)


@pytest.fixture(scope="session")
def limited(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """The study of `LIMITS` that has run to its end; tests only read it."""
    return run_once(tmp_path_factory, "limits", LIMITS)


@pytest.fixture
def study(tmp_path: Path) -> Study:
    """A tiny study that has not run yet."""
    return Study(tmp_path / "study")


@pytest.fixture
def copy(finished: Study, tmp_path: Path) -> Study:
    """A copy of the finished study."""
    return copied(finished.folder, tmp_path / "copy")
