"""`bk attractors`, `basins`, `orbit`, `exponents`, `catalogue`: what they print and write is what the library gives."""

import shlex

import numpy as np
import pytest
import xarray as xr

import burridge_knopoff
from burridge_knopoff import Model, Settings, limit_cycle, multipliers, synchronized_orbit
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.cli import main
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.kind import format_motion, motion_of_run
from burridge_knopoff.motion.settings import MOTION
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.status import EXIT_CODE
from burridge_knopoff.show.attractors import attractor_table
from burridge_knopoff.study.formatting import to_ascii, with_error

MODEL = Model("linearized", a=0.08)
GIVEN = ["--law", "linearized", "--a", "0.08"]
#: Little of a search, in settings and as options.
SHORT = {"samples": 12, "lifetime": 1000.0, "transient": 500.0, "window": 500.0, "time_limit": 5000.0}
SHORT |= {"perturbations": 4}
OPTIONS = [word for key, value in SHORT.items() for word in (f"--{key.replace('_', '-')}", f"{value:g}")]


def said(capsys, *arguments):
    assert main(arguments) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    return printed.out


def test_attractors(capsys, tmp_path):
    out = tmp_path / "attractors.nc"
    command = ["attractors", *GIVEN, *OPTIONS, "--fraction-width", "0.15", "--initial", "plus"]
    printed = said(capsys, *command, "--out", str(out))
    attractors, labels = burridge_knopoff.find_attractors(MODEL, SearchSettings(**SHORT), starts=[PAPER_STATES["plus"]])
    written = open_summary(out)
    assert written.attrs["history"] == shlex.join(["bk", *command])
    assert written.sizes["attractor"] == len(attractors)
    means = sorted(attractor.motion.mean_distance for attractor in attractors)
    assert np.sort(written["mean_distance"].values.ravel()) == pytest.approx(means, abs=1e-12)
    rows = printed.splitlines()
    assert rows[0] == f"linearized law, a = 0.08, v = 0.1, 3 blocks: {len(attractors)} attractors"
    assert "  motion, section points  " in rows[2]
    # An exponent is 0 within its error from either side.
    below = written.assign(lyapunov_exponent=xr.full_like(written["lyapunov_exponent"], -1e-5))
    assert all("   0.0000  0.0000  0.0000" in line for line in attractor_table(below, {})[1:])
    means = np.array([written[f"mean_distance{end}"].values[0, 0] for end in ("", "_error")])
    for slot, name in enumerate(written["branch_name"].values):
        row = next(line for line in rows if line.startswith(f"{name}  "))
        assert f"  {to_ascii(with_error(*means[:, slot].tolist()))}  " in row
        assert f"  {100 * written['basin_fraction'].values[0, 0, slot]:.1f} (" in row
    reached = attractors[labels[-1]].motion.mean_distance
    name = written["branch_name"].values[np.abs(written["mean_distance"].values[0, 0] - reached).argmin()]
    assert f"plus reaches: {name}\n" in printed
    assert said(capsys, "show", str(out)).count(f"\n{name}  ") == 1


def test_basins(capsys, tmp_path, monkeypatch):
    files = [tmp_path / name for name in ("basins.nc", "attractors.nc")]
    plane = ["--pixels", "6", "--first-position", "-1.2,1", "--cores", "2"]
    out = ["--out", str(files[0]), "--attractors-out", str(files[1])]
    printed = said(capsys, "basins", *GIVEN, *OPTIONS, *plane, *out)
    expected = burridge_knopoff.basin_map(MODEL, pixels=6, first_position=(-1.2, 1.0), **SHORT)
    for path, dataset in zip(files, expected, strict=True):
        xr.testing.assert_identical(open_summary(path).drop_attrs(), dataset.drop_attrs())
    branch = expected[0]["branch"].values
    for number, name in zip(*(expected[1][f"branch_{key}"].values for key in ("number", "name")), strict=True):
        row = next(line for line in printed.splitlines() if line.startswith(f"{name}  "))
        assert row.endswith(f"  {100 * (branch == number).mean():.2f} %")
    picture = tmp_path / "basins.png"
    monkeypatch.setenv("COLUMNS", "1000")
    # Without attractors.nc only the colours may differ.
    for _ in range(2):
        assert f"{picture}: Basins of attraction. " in said(capsys, "show", str(files[0]), "--plot", str(picture))
        assert picture.stat().st_size > 10_000
        files[1].unlink(missing_ok=True)


def test_basins_of_one_block(capsys):
    one = ["--formula", "1/(1 + u)", "--blocks", "1", "--contact", "symmetric", "--position", "0", "--velocity", "0"]
    printed = said(capsys, "basins", *one, *OPTIONS, "--pixels", "2", "--first-velocity", "v - 0.5,2")
    assert "v = 0.1, 1 block: 2 x 2 states, U_1(0) -1.5 to 1.5, U_1'(0) -0.4 to 2\n" in printed
    assert main(["basins", *one, *OPTIONS, "--last-position", "0,1"]) == 2
    assert capsys.readouterr().err.startswith("bk basins: last_position: got (0.0, 1.0), expected first_velocity in")


def test_the_synchronized_orbit(capsys):
    for a, words in ((0.08, "stable: no multiplier outside"), (0.12, "unstable: 1 multiplier outside")):
        orbit = synchronized_orbit(MODEL.at(a=a))
        printed = said(capsys, "orbit", "--law", "linearized", "--a", str(a))
        assert f"period       {orbit.period:.9f}\n" in printed
        assert f"mirror-breaking perturbations: {multipliers(orbit).transverse.real:.6g}\n" in printed
        assert f"stability    {words} the unit circle\n" in printed
        assert printed.count(" stops\n") == printed.count(" starts\n") == 3


def test_a_synchronized_orbit_that_repels_symmetric_perturbations(capsys):
    """At coupling 1.5 synchronized motion of another period attracts: the transverse multiplier does not decide."""
    for coupling, repels in ((1.5, True), (1.0, False)):
        options = ["--law", "linearized", "--a", "0.2", "--coupling", str(coupling)]
        printed = said(capsys, "orbit", *options)
        model = Model("linearized", a=0.2, coupling=coupling)
        symmetric = multipliers(synchronized_orbit(model)).symmetry_preserving[0]
        assert f"mirror-symmetric perturbations: {symmetric.real:.6g}" in printed
        assert ("synchrony    the orbit repels mirror-symmetric perturbations" in printed) == repels


def test_an_orbit_without_stops(capsys):
    law = ["--formula", "1 - a*u + b*u**3", "--number", "b=0.3", "--a", "0.5", "--v", "0.7"]
    printed = said(capsys, "orbit", *law, "--position=-0.5,-0.9", "--velocity", "0.5,0.7")
    assert "\nmultipliers  1 (the flow), -0.857372 +- 0.289472i, 0.78922\nstops        none\n" in printed
    assert printed.splitlines()[-1].startswith("residual")


def test_the_orbit_that_a_state_comes_to(capsys):
    orbit = limit_cycle(MODEL, MODEL.begin(PAPER_STATES["plus"]), 3000.0)
    printed = said(capsys, "orbit", *GIVEN, "--initial", "plus", "--events", "4")
    assert f"period       {orbit.period:.9f}\n" in printed
    assert "symmetry     symmetric\n" in printed
    assert f"stops        {' '.join(map(str, orbit.stop_counts))} (each block, in a period)" in printed
    assert printed.endswith(f"and {len(orbit.events) - 4} more: --events {len(orbit.events)}\n")


def test_exponents(capsys, tmp_path):
    out = tmp_path / "run.nc"
    settings = Settings(transient=500.0, window=500.0, batches=2, lyapunov_exponents=2)
    options = ["--transient", "500", "--window", "500", "--batches", "2", "--lyapunov-exponents", "2"]
    printed = said(capsys, "exponents", *GIVEN, *options, "--out", str(out))
    trajectory = run(MODEL, PAPER_STATES["minus"], settings)
    for number, value in enumerate(trajectory.lyapunov_exponent, 1):
        assert f"\n{number}  {value + 0.0:.6f}" in printed
    assert f"motion: {format_motion(motion_of_run(vars(trajectory), True, MOTION), MOTION)}\n" in printed
    value, error = map(float, printed.split("symmetric motion: ")[1].splitlines()[0].split(" +- "))
    orbit = synchronized_orbit(MODEL)
    assert value == pytest.approx(np.log(multipliers(orbit).transverse.real) / orbit.period, abs=4.0 * error)
    assert error < 0.003
    with xr.open_dataset(out) as point:
        assert point["mean_distance"].item() == trajectory.mean_distance


def test_a_run_that_did_not_complete_has_no_exponents(capsys):
    """Backward slip under the linearized law grows without limit. Not a number was once a result of the table."""
    state = ["--contact", "symmetric", "--position=-1,-0.5,-0.8", "--velocity", "0.1,0,0.2"]
    length = ["--transient", "500", "--window", "500", "--batches", "2"]
    assert main(["exponents", "--law", "linearized", "--a", "2.5", *state, *length]) == EXIT_CODE
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("from own: the run did not complete: diverged at tau = 12.1596")
    assert lines[2:] == [
        "no exponents, no kind of motion and no <J>",
        "transverse exponent of the nearby symmetric motion: none, its run did not complete",
    ]


def test_a_catalogue_that_is_not_complete_has_no_rates(capsys, monkeypatch):
    """Ten slips of a block, of which each has a stop and a start, without a slope and the rest of the window."""
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 200)
    state = ["--blocks", "1", "--pulling", "1", "--position=-0.9", "--velocity", "0", "--start", "tested"]
    length = ["--transient", "10", "--window", "5000"]
    assert main(["catalogue", "--law", "linearized", "--a", "0.1", "--v", "0.01", *state, *length]) == EXIT_CODE
    head, _, events, magnitude, ended = capsys.readouterr().out.splitlines()
    assert head.endswith(": step_limit")
    assert events.endswith(" from tau = 10 until the run ended")
    assert int(events.split()[1]) > 5
    assert magnitude.startswith("magnitude ")
    assert ended.startswith("the run did not complete: step limit at tau = ")
    assert ended.endswith("; there are no rates and no slope")
