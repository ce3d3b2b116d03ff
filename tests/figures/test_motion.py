"""Motion and distance of one run: the curves are its data, the style is nobody else's, the bytes are the same."""

import matplotlib as mpl
import numpy as np
import pytest

from burridge_knopoff import Model, simulate
from burridge_knopoff.figures import distance, motion
from burridge_knopoff.figures.style import write_figure
from tests.conftest import quick_first


@pytest.fixture(scope="module")
def point():
    return simulate(Model("linearized", a=0.08), "plus", transient=50.0, window=50.0, batches=2).to_dataset()


def test_motion_draws_every_block_in_a_style_that_is_nobody_elses(point):
    before = dict(mpl.rcParams)
    figure = motion.draw({"plus": point})
    assert dict(mpl.rcParams) == before
    for panel, name in zip(figure.axes[:2], ("velocity", "position"), strict=True):
        assert len(panel.get_lines()) == 3
        assert (panel.get_lines()[2].get_ydata() == point[name].values[:, 2]).all()


def test_the_section_shows_each_upward_crossing_against_the_one_before(point):
    upward = point["crossing_velocity"].values[point["crossing_direction"].values > 0]
    section, times = motion.draw({"plus": point}).axes[2:]
    (points,), (in_time,) = section.get_lines(), times.get_lines()
    assert (points.get_xdata() == upward[:-1]).all()
    assert (points.get_ydata() == upward[1:]).all()
    assert (in_time.get_ydata() == upward).all()
    none = point.isel(crossing=slice(0))
    assert [[text.get_text() for text in panel.texts] for panel in motion.draw({"plus": none}).axes[2:]] == [
        ["$W$ crosses 0 upward\nless than twice in the window"],
        ["no section points"],
    ]


def test_the_linear_scale_of_a_distance_is_cut_only_far_above_what_follows():
    settled = np.full(200, 0.1)
    for first, top in ((0.4, 0.42), (0.8, 0.125)):
        assert distance.linear_top(np.append(first, settled)) == pytest.approx(top)
    assert distance.linear_top(np.append(0.4, 0.0 * settled)) == pytest.approx(0.42)
    assert distance.linear_top(np.zeros(200)) is None


def test_distance_draws_both_scales(point):
    figure = distance.draw({"plus": point})
    assert (figure.axes[0].get_lines()[0].get_ydata() == point["distance"].values).all()
    assert figure.axes[1].get_yscale() == "log"


@pytest.mark.parametrize("suffix", quick_first(["png", "pdf"], 1))
def test_the_same_figure_gives_the_same_bytes(tmp_path, point, suffix):
    for name in ("one", "two"):
        write_figure(motion.draw({"plus": point}), tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"two.{suffix}").read_bytes()
    assert len(list(tmp_path.iterdir())) == 2


def test_no_two_blocks_that_are_named_look_the_same(point):
    blocks = {"block": range(1, motion.MOST_NAMED + 1)}
    many = point.isel(block=[0] * motion.MOST_NAMED).assign_coords(blocks)
    lines = motion.draw({"plus": many}).axes[0].get_lines()
    assert len({(line.get_color(), str(line._dash_pattern)) for line in lines}) == motion.MOST_NAMED


def test_the_end_of_a_run_is_drawn_below_a_band_of_j_and_not_over_a_curve(point):
    count = len(point["distance"])
    band = point.assign(distance=(point["distance"].dims, np.full(count, 0.1)))
    linear, _ = distance.draw({"plus": band}).axes[:2]
    (inset,) = linear.child_axes
    (curve,) = inset.get_lines()
    assert curve.get_xdata().tolist() == point["trajectory_time"].values.tolist()
    position, velocity = (point[name].values for name in ("position", "velocity"))
    expected = np.hypot(position[:, -1] - position[:, 0], velocity[:, -1] - velocity[:, 0])
    assert curve.get_ydata() == pytest.approx(expected)
    falling = point.assign(distance=(point["distance"].dims, np.exp(-0.1 * np.arange(count))))
    assert not distance.draw({"plus": falling}).axes[0].child_axes
