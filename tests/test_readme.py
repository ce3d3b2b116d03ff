"""README: its numbers are those of the ledger in docs/verdicts.md, and linked files exist."""

import re
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.image import imread

from burridge_knopoff import Model, multipliers, simulate, synchronized_orbit
from burridge_knopoff.running.settling import LEVELS
from tests.pages import claim_sections, outputs

#: Row of the table, claim, and the beginnings of its numbers.
NUMBERS = [
    ("Synchrony", "upper_edge", ["0.08697", "0.08872"]),
    ("⟨J⟩ from", "plus_mean_distance", ["0.14064"]),
    ("J from", "minus_distance_vanishes", ["1064.85"]),
    ("Frequency of", "half_frequency", ["0.648", "0.370"]),
    ("Time of", "cycle_time", ["5.7", "7.1", "2.1", "2.2", "2.9"]),
]


@pytest.fixture(scope="module")
def claims(repository) -> dict[str, str]:
    return claim_sections(repository)


def test_the_two_commands_of_a_fresh_machine_stand_together_before_the_paper(repository):
    first_screen = (repository / "README.md").read_text(encoding="utf-8").partition("\n## ")[0]
    blocks = re.findall(r"```sh\n(.*?)```", first_screen, re.DOTALL)
    commands = [[line.partition("#")[0].strip() for line in block.splitlines()] for block in blocks]
    assert any({"make", "make test"} <= {*block} for block in commands)


@pytest.mark.parametrize(("row", "claim", "printed"), NUMBERS)
def test_the_numbers_are_those_of_the_ledger(repository, claims, row, claim, printed):
    text = (repository / "README.md").read_text(encoding="utf-8")
    [line] = re.findall(rf"^\| {row}.*$", text, re.MULTILINE)
    ours = line.split("|")[3]
    exact = [float(number) for number in re.findall(r"\d+\.\d+", claims[claim])]
    for number in printed:
        assert number in ours
        digits = len(number.partition(".")[2])
        assert number in [f"{value:.{digits}f}" for value in exact]


def test_chaos_first_appears_where_the_ledger_says(repository, claims):
    [line] = re.findall(r"^\| Chaos first.*$", (repository / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    ours = re.findall(r"0\.\d{4}", line)
    bounds = re.findall(r"between ([\d.]+) and ([\d.]+) \(", claims["transition"])
    assert len(ours) == len(bounds) == 2
    assert all(float(low) < float(a) < float(high) for a, (low, high) in zip(ours, bounds, strict=True))


def test_the_distance_from_minus_vanishes_in_a_run(repository):
    """Below the threshold of synchrony, and below a thousandth of it as much later as the multiplier says."""
    trajectory = simulate(Model("linearized", a=0.08), "minus", transient=3000.0, window=100.0, lyapunov_exponents=0)
    settled, later = (trajectory.settling_time[LEVELS.index(level)] for level in (1e-6, 1e-9))
    orbit = synchronized_orbit(Model("linearized", a=0.08))
    rate = -np.log(abs(multipliers(orbit).symmetry_breaking[0])) / orbit.period
    # J oscillates within a period of 5.7.
    assert later - settled == pytest.approx(np.log(1e3) / rate, abs=orbit.period)
    [line] = re.findall(r"^\| J from.*$", (repository / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert f"from {settled:.2f} on" in line


@pytest.mark.slow
def test_the_time_of_the_study_is_that_of_a_dry_run(repository, tmp_path):
    command = [sys.executable, "-m", "snakemake", "-n", "-c2", "--snakefile", "Snakefile", "-d", str(tmp_path / "new")]
    configured = [*command, "--configfile", str(repository / "config/paper.yaml")]
    process = subprocess.run(configured, check=True, capture_output=True, text=True, cwd=repository)
    [minutes] = re.findall(r"a run takes about (\d+) min on 2 cores", process.stdout + process.stderr)
    for page in ("README.md", "docs/performance.md"):
        text = " ".join((repository / page).read_text(encoding="utf-8").split())
        assert f"{minutes} minutes on two cores" in text


@pytest.mark.slow
def test_the_first_lines_of_python_print_and_draw_what_the_page_shows(repository, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    [(_, expected, printed)] = outputs((repository / "README.md").read_text(encoding="utf-8"), "README.md")
    assert printed == expected
    for name in ("run.png", "basins.png"):
        mine, committed = (imread(path) for path in (name, repository / f"docs/figures/readme_{name}"))
        assert mine.shape == committed.shape
        assert np.abs(mine - committed).mean() < 0.001


def test_pictures_and_linked_files_exist(repository):
    text = (repository / "README.md").read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
        assert (repository / target).exists(), target
