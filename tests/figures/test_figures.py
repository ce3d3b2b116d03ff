"""Figures show what they are given: data of the curves, gaps for missing values, the caller's style untouched."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

from burridge_knopoff.figures import distance, friction_laws, mean_distance, motion, orbits, stick_slip
from burridge_knopoff.figures import equilibrium as equilibrium_figure
from burridge_knopoff.figures.branches import branch_colors
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.simulation import simulate
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries import equilibrium
from burridge_knopoff.summaries.orbits import summarize


def paper_models(blocks):
    """The paper's laws on its chain of so many blocks."""
    return [Model(Chain(blocks), law_of(law, 0.1)) for law in PAPER_LAWS]


@pytest.fixture(scope="module")
def point():
    return simulate("linearized", 0.08, "plus", transient=50.0, window=50.0, batches=2).to_dataset()


def test_mean_distance_leaves_a_gap_where_a_run_has_no_result():
    shape = (2, 1, 3)
    values = np.array([[[0.0, np.nan, 0.2]], [[0.0, 0.1, 0.3]]])
    dataset = xr.Dataset(
        {
            "mean_distance": (("law", "initial", "a"), values),
            "mean_distance_error": (("law", "initial", "a"), np.full(shape, 0.01)),
        },
        {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )
    panels = mean_distance.draw(dataset, known_attractors()).axes
    attractors, run = (line for line in panels[0].get_lines() if len(line.get_ydata()) in (2, 3))
    assert np.array_equal(run.get_ydata(), values[0, 0], equal_nan=True)
    assert attractors.get_ydata().tolist() == [0.1, 0.2]
    assert panels[0].get_title(loc="left") == "(a) linearized law"


def known_attractors():
    """One branch that exists at two of three values of a, which the run reaches at one under one convention."""
    names = {"law": ["linearized", "nonlinear"], "contact": ["one_sided", "symmetric"], "start": ["moving", "tested"]}
    branch = np.array([[[-1], [1], [1]]] * 2)
    reached = np.full((2, 2, 2, 1, 3), -1)
    reached[:, 0, 0, 0, 1] = 1
    return xr.Dataset(
        {
            "branch": (("law", "a", "attractor"), branch),
            "mean_distance": (("law", "a", "attractor"), np.array([[[np.nan], [0.1], [0.2]]] * 2)),
            "initial_branch": (("law", "contact", "start", "initial", "a"), reached),
        },
        {**names, "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )


def test_the_branch_reached_is_coloured_and_an_undetermined_one_is_white():
    values = np.zeros((2, 1, 3))
    names = ("law", "initial", "a")
    means = xr.Dataset(
        {"mean_distance": (names, values), "mean_distance_error": (names, values)},
        {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.1, 0.2]},
    )
    attractors = known_attractors()
    strips = mean_distance.draw(means, attractors).axes[2]
    picture = strips.collections[0].get_array()
    color = to_rgb(branch_colors(attractors)[1])
    assert picture.shape == (4, 3, 3)
    assert np.allclose(picture[0, 1], color)
    assert (picture[0, 0] == 1.0).all()
    assert (picture[1:] == 1.0).all()


def test_motion_draws_every_block(point):
    figure = motion.draw({"plus": point})
    for panel, name in zip(figure.axes, ("velocity", "position"), strict=True):
        assert len(panel.get_lines()) == 3
        assert (panel.get_lines()[2].get_ydata() == point[name].values[:, 2]).all()


def test_distance_draws_both_scales(point):
    figure = distance.draw({"plus": point})
    assert (figure.axes[0].get_lines()[0].get_ydata() == point["distance"].values).all()
    assert figure.axes[1].get_yscale() == "log"


def test_orbits_says_that_there_are_none():
    figure = orbits.draw(summarize(paper_models(2), [0.1]), xr.Dataset())
    assert [panel.texts[0].get_text() for panel in figure.axes] == ["no synchronized orbit found"] * 4


def test_friction_laws_are_the_models():
    least = np.array([[[1.0, 0.7]], [[1.0, np.nan]]])
    runs = xr.Dataset(
        {"least_friction": (("law", "initial", "a"), least)},
        {"law": ["linearized", "nonlinear"], "initial": ["plus"], "a": [0.0, 0.3]},
    )
    laws, seen = friction_laws.draw(runs, {law: {} for law in PAPER_LAWS}, 0.3).axes
    for number, law in enumerate(PAPER_LAWS):
        drawn = seen.get_lines()[number].get_ydata()
        assert np.array_equal(drawn, least[number, 0], equal_nan=True)
        speed, friction = laws.get_lines()[1 + number].get_data()
        assert np.allclose(friction, {"linearized": 1.0 - 0.3 * speed, "nonlinear": 1.0 / (1.0 + 0.3 * speed)}[law])


def test_the_legend_of_the_laws_has_their_formulas_and_numbers():
    laws = {
        "linearized": {},
        "drop": {"law": "carlson_langer", "sigma": 0.02},
        "own": {"formula": "1 - c*tanh(a*u/c)" + " + 0*u" * 60, "c": 0.1},
    }
    runs = xr.Dataset(
        {"least_friction": (("law", "initial", "a"), np.ones((3, 1, 1)))},
        {"law": list(laws), "initial": ["plus"], "a": [0.3]},
    )
    figure = friction_laws.draw(runs, laws, 0.2)
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert entries[:2] == ["linearized: Φ = 1 − aU′", "drop: Φ = (1 − σ)/(1 + aU′/(1 − σ)), σ = 0.02"]
    assert entries[2].startswith("own: Φ = 1 - c*tanh(a*u/c)")
    assert entries[2].count("\n") == 2
    assert friction_laws.law_text(law_of("own", 0.1, {"formula": "1 - c*u", "c": 0.1})).count("c = 0.1") == 1


def test_the_callers_style_is_untouched(point):
    before = dict(mpl.rcParams)
    motion.draw({"plus": point})
    assert dict(mpl.rcParams) == before


@pytest.mark.parametrize("suffix", ["pdf", "png"])
def test_the_same_figure_gives_the_same_bytes(tmp_path, point, suffix):
    for name in ("one", "two"):
        write_figure(motion.draw({"plus": point}), tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"two.{suffix}").read_bytes()
    assert len(list(tmp_path.iterdir())) == 2


def cycles(blocks, initial=("minus",)):
    """A summary of stick-slip cycles with other numbers for every block, and a gap for one that never stops."""
    a = np.array([0.0, 0.1, 0.2])
    names = ("law", "initial", "a", "block")
    shape = (2, len(initial), 3, blocks)
    block = np.arange(1.0, blocks + 1)
    values = {
        name: (names, np.broadcast_to(block * (1.0 + a[:, None]), shape).copy())
        for name in ("stop_rate", "cycle_time", "cycle_time_error", "stick_fraction", "velocity_frequency")
    }
    values["velocity_frequency_error"] = (names, np.full(shape, 0.01))
    values["cycle_time"][1][:, :, 0, 0] = np.nan
    values["stop_rate"][1][:, :, 0] = 0.0
    values["velocity_correlation"] = (names[:3], np.full(shape[:3], -0.5))
    labels = {"law": ["linearized", "nonlinear"], "initial": list(initial), "a": a, "block": np.arange(1, blocks + 1)}
    return xr.Dataset(values, labels)


@pytest.mark.parametrize(("blocks", "shown"), [(2, [1, 2]), (3, [1, 2, 3]), (6, [1, 3, 6])])
def test_stick_slip_shows_the_first_the_middle_and_the_last_block(tmp_path, blocks, shown):
    dataset = cycles(blocks)
    figure = stick_slip.draw(dataset, "nonlinear")
    panels = figure.axes
    assert len(panels) == 4
    drawn = [line.get_ydata(orig=False) for line in panels[0].get_lines() if len(line.get_ydata()) == 3]
    expected = dataset["cycle_time"].sel(law="nonlinear", initial="minus")
    for values, block in zip(drawn, shown, strict=True):
        assert np.array_equal(values, expected.sel(block=block), equal_nan=True)
    middle = (blocks + 1) // 2
    ratios = [line.get_ydata() for line in panels[1].get_lines() if len(line.get_ydata()) == 3]
    ends = [block for block in shown if block != middle]
    for number, block in enumerate(ends):
        assert ratios[2 * number] == pytest.approx([block / middle] * 3)
        # Where the middle block never stops there is no ratio of stops.
        assert ratios[2 * number + 1] == pytest.approx([np.nan, block / middle, block / middle], nan_ok=True)
    assert len(ratios) == 2 * len(ends)
    assert panels[1].get_ylabel() == f"ratio to block {middle}"
    write_figure(figure, tmp_path / "figure.png")


def test_equilibrium_draws_eigenvalues_and_simulated_rates():
    dataset = equilibrium.summarize(paper_models(3), [0.0, 0.1, 0.2])
    plane, growth = equilibrium_figure.draw(dataset).axes
    half, *drawn = (line.get_ydata().tolist() for line in growth.get_lines())
    assert half == [0.0, 0.05, 0.1]
    assert drawn[3] == dataset["growth_rate"].sel(law="nonlinear").values.tolist()
    real = dataset["eigenvalue"].sel(part="real", law="nonlinear").max("mode")
    assert drawn[2] == real.values.tolist()
    assert len([line for line in plane.get_lines() if len(line.get_xdata()) == 3]) == 12
