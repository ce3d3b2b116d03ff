"""README: the numbers of its table are those of the default study's ledger, and linked files exist."""

import json
import re
import subprocess
import sys

import numpy as np
import pytest
import xarray

from burridge_knopoff import Chain, Model, law_of, multipliers, simulate, synchronized_orbit
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.running.settling import LEVELS

NUMBERS = [
    (
        "Synchrony from",
        "upper_edge",
        "a_c, at which the synchronized orbit loses stability, linearized",
        "0.08697",
    ),
    ("Synchrony", "upper_edge", "a_c, at which the synchronized orbit loses stability, nonlinear", "0.08872"),
    ("⟨J⟩ from", "plus_mean_distance", "⟨J⟩, linearized", "0.14064"),
    ("J from", "minus_distance_vanishes", "time τ from which on J < 1e-06", "1064.85"),
    ("Frequency of", "half_frequency", "frequency of the velocity of block 1 over that of block 2", "0.648"),
    ("Chaos first", "transition", "smallest a with a chaotic attractor, linearized", "0.1324"),
    ("Chaos first", "transition", "smallest a with a chaotic attractor, nonlinear", "0.1366"),
]


@pytest.fixture(scope="module")
def claims(repository) -> dict:
    content = json.loads((repository / "docs/claims.json").read_text(encoding="utf-8"))
    return {claim["name"]: claim for claim in content["claims"]}


@pytest.mark.parametrize(("row", "claim", "quantity", "printed"), NUMBERS)
def test_the_numbers_are_those_of_the_ledger(repository, claims, row, claim, quantity, printed):
    text = (repository / "README.md").read_text(encoding="utf-8")
    [line] = re.findall(rf"^\| {row}.*$", text, re.MULTILINE)
    [value] = [item["value"] for item in claims[claim]["measured"] if item["quantity"] == quantity]
    digits = len(printed.partition(".")[2])
    assert f"{value:.{digits}f}" == printed
    assert printed in line.split("|")[3]


def test_the_distance_from_minus_vanishes_in_a_run(repository):
    """Below the threshold of synchrony, and below a thousandth of it as much later as the multiplier says."""
    trajectory = simulate("linearized", 0.08, "minus", transient=3000.0, window=100.0, lyapunov_exponents=0)
    settled, later = (trajectory.settling_time[LEVELS.index(level)] for level in (1e-6, 1e-9))
    orbit = synchronized_orbit(Model(Chain(3), law_of("linearized", 0.08)))
    rate = -np.log(abs(multipliers(orbit).symmetry_breaking[0])) / orbit.period
    # J oscillates within a period of 5.7.
    assert later - settled == pytest.approx(np.log(1e3) / rate, abs=orbit.period)
    [line] = re.findall(r"^\| J from.*$", (repository / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert f"from {settled:.2f} on" in line


def test_the_laws_agree_as_often_as_the_study_says(repository):
    """Of ⟨J⟩ and kinds below a = 0.1, from agreement.nc of the default study."""
    path = repository / "results/paper/summary/agreement.nc"
    if not path.exists():
        pytest.skip("the default study has not run")
    agrees = xarray.load_dataset(path)["agrees"].sel(other_law="nonlinear")
    agrees = agrees.where((agrees["a"] > 0.0) & (agrees["a"] < 0.1), drop=True)
    minus, plus = (int((agrees.sel(initial=name) == Answer.YES).sum()) for name in ("minus", "plus"))
    text = " ".join((repository / "README.md").read_text(encoding="utf-8").split())
    assert f"{minus} of the {agrees.sizes['a']} values of a below 0.1 from `minus`" in text
    assert f"and at {plus} from `plus`" in text


def test_plus_synchronizes_as_often_as_the_ledger_says(repository, claims):
    measured = {item["quantity"]: item["value"] for item in claims["plus_does_not_synchronize"]["measured"]}
    ours = [round(100 * (1 - measured[f"share of a with no synchrony, {law}"])) for law in ("linearized", "nonlinear")]
    text = " ".join((repository / "README.md").read_text(encoding="utf-8").split())
    assert (
        "at {} % (linearized law) and {} % (nonlinear law) of the values of a from 0.005 to 0.08".format(*ours) in text
    )


def test_the_times_of_a_cycle_are_those_of_the_ledger(repository, claims):
    reason = claims["cycle_time"]["reason"]
    interval, *_ = re.findall(r"([\d.]+) to ([\d.]+) between successive stops of one block", reason)
    both, *_ = re.findall(r"([\d.]+) to ([\d.]+) between successive stops of any blocks", reason)
    text = (repository / "README.md").read_text(encoding="utf-8")
    ours = "{:.1f} to {:.1f} for one block and {:.1f} to {:.1f} between stops of any blocks (medians over a)"
    assert ours.format(*map(float, (*interval, *both))) in text


@pytest.mark.slow
def test_the_time_of_the_study_is_that_of_a_dry_run(repository, tmp_path):
    command = [sys.executable, "-m", "snakemake", "-n", "-c2", "--snakefile", "Snakefile", "-d", str(tmp_path / "new")]
    configured = [*command, "--configfile", str(repository / "config/paper.yaml")]
    process = subprocess.run(configured, check=True, capture_output=True, text=True, cwd=repository)
    [minutes] = re.findall(r"a run takes about (\d+) min on 2 cores", process.stdout + process.stderr)
    for page in ("README.md", "docs/performance.md"):
        text = " ".join((repository / page).read_text(encoding="utf-8").split())
        assert f"{minutes} minutes on two cores" in text


def test_the_map_of_basins_is_drawn_by_the_first_lines_of_python(repository, tmp_path, monkeypatch):
    text = (repository / "README.md").read_text(encoding="utf-8")
    lines = re.findall(r"^>>> (.*)$", re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    exec("\n".join(lines), names := {})
    assert (tmp_path / "basins.png").stat().st_size > 10_000
    assert {0, 1, 2} == {*names["maps"]["branch"].values.ravel().tolist()}


def test_pictures_and_linked_files_exist(repository):
    text = (repository / "README.md").read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
        assert (repository / target).exists(), target
