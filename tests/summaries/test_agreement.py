"""Verdicts on agreement follow the data."""

import dataclasses

import numpy as np
import pytest
import xarray
from scipy.stats import wasserstein_distance

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.study.study import all_points
from burridge_knopoff.summaries import agreement
from burridge_knopoff.summaries.judgement import compare_laws
from tests.grids import grid_of
from tests.sections import AGREEMENT, MOTION
from tests.summaries.points import kinds, means, scalars, write_points

SETTINGS = {"transient": 2000.0, "window": 400.0, "batches": 4}


@pytest.fixture(scope="module")
def runs():
    """Runs from one initial state at two values of a under both laws."""
    return {(law, a): simulate(Model(law, a=a), "minus", **SETTINGS) for law in PAPER_LAWS for a in (0.05, 0.08)}


@pytest.fixture
def compare(runs, tmp_path):
    """Write the runs, some of them altered, and return their study and its folder with the comparison."""

    def compared(altered=(), **reached):
        grid = study, _ = grid_of(tmp_path, ["minus"], {"0.0500": 0.05, "0.0800": 0.08}, **SETTINGS)
        for point in all_points(study):
            key = point["law"], study.value(point["a"])
            values = {**dict(altered).get(key, {})}
            if "mean_distance" in values:
                values["batch_mean_distance"] = np.full_like(runs[key].batch_mean_distance, values["mean_distance"])
            write_point(dataclasses.replace(runs[key], **values), tmp_path / study.run_file(**point))
        return grid, summarize_kinds(grid, attractors_of(study, **reached))

    return compared


@pytest.fixture(scope="module")
def read(runs, tmp_path_factory):
    """The study of the runs, and what is read from their files."""
    results = tmp_path_factory.mktemp("runs")
    grid = study, _ = grid_of(results, ["minus"], {"0.0500": 0.05, "0.0800": 0.08}, **SETTINGS)
    for point in all_points(study):
        write_point(runs[point["law"], study.value(point["a"])], results / study.run_file(**point))
    return study, scalars(*grid), kinds(*grid, MOTION), agreement.compare_events(*grid)


def kinds_with(read, mean_distance, run_kind, **reached):
    """Return the comparison of runs that all have one exact ⟨J⟩ and kind, with attractors, see `attractors_of`."""
    study, means, of_runs, events = read
    values = {"mean_distance": mean_distance, "mean_distance_error": 0.0}
    means = means.assign({name: xarray.full_like(means[name], value) for name, value in values.items()})
    of_runs = of_runs.assign(run_kind=xarray.full_like(of_runs["run_kind"], run_kind))
    return compared_with(means, of_runs, events, attractors_of(study, **reached))


def compared_with(*summaries):
    return agreement.summarize(*summaries, synchronization_threshold=1e-6, agreement=AGREEMENT)


def summarize_kinds(grid, *attractors):
    """Return the comparison of the runs in the files of a grid."""
    return compared_with(scalars(*grid), kinds(*grid, MOTION), agreement.compare_events(*grid), *attractors)


def test_without_attractors_it_is_undetermined_which_runs_settled(compare):
    grid, dataset = compare()
    other = summarize_kinds(grid)
    assert (other["settled"] == -1).all()
    xarray.testing.assert_identical(other.drop_vars("settled"), dataset.drop_vars("settled"))


def attractors_of(study, mean=0.0, error=0.0, branch=0, kind=-1, v=0.1):
    """Return attractors of one ⟨J⟩, branch and kind at all a, which all states reach under the study's conventions."""
    laws, states, a = study.laws, list(study.initial), list(study.grid.values())
    labels = {"law": list(laws), "contact": ["here", "there"], "start": ["now", "then"], "initial": states, "a": a}
    slot = xarray.DataArray(np.zeros((len(laws), len(a), 2)), dims=("law", "a", "attractor"))
    initial_branch = xarray.DataArray(np.full([len(item) for item in labels.values()], 9), labels, tuple(labels))
    initial_branch.loc[{"contact": "there", "start": "now"}] = branch
    return xarray.Dataset(
        {
            "branch": slot.copy(data=np.broadcast_to([-1, branch], slot.shape)),
            "side": slot.astype(int),
            "kind": slot.astype(int) + kind,
            "period": slot + 40.0,
            "mean_distance": slot + mean,
            "mean_distance_error": slot + error,
            "initial_branch": initial_branch,
            "initial_side": xarray.zeros_like(initial_branch),
        },
        attrs={"contact": "there", "start": "now", "resolution": 1e-3, "v": v},
    )


def test_two_synchronized_laws_agree(compare, runs):
    _, dataset = compare()
    assert (dataset["agrees"] == 1).all()
    assert (dataset["kind"] == 0).all()
    assert np.isnan(dataset["parting_a"].item())
    words = "they agree at all 2 values of a that were compared, 0.05 to 0.08."
    assert agreement.digest(dataset) == f"minus, nonlinear law compared with the linearized law: {words}\n"
    for k, a in enumerate((0.05, 0.08)):
        first, other = (runs[law, a] for law in PAPER_LAWS)
        upward = [run.crossing_velocity[run.crossing_direction > 0] for run in (first, other)]
        assert dataset["section_distance"].values[0, 0, k] == float(f"{wasserstein_distance(*upward):.12g}")
        errors = [first.mean_distance_error, other.mean_distance_error]
        assert dataset["mean_distance_error"].values[:, 0, k].tolist() == errors
        # Under the two laws events occur at different times, but initially in the same order.
        count, until = dataset["event_order_count"].values[0, 0, k], dataset["event_order_time"].values[0, 0, k]
        assert 4 < count <= min(first.event_count, other.event_count)
        assert 0.0 < until <= 2400.0
    head, *rows = agreement.table(dataset).splitlines()
    assert head == (
        "initial,a,mean_distance_linearized,mean_distance_nonlinear,difference,difference_error,section_distance,"
        "event_order_time,kind_linearized,kind_nonlinear,settled_linearized,settled_nonlinear,agrees"
    )
    point = dataset.isel(initial=0, other_law=0, a=1)
    assert rows[1] == (
        f"minus,0.08,{point['mean_distance'].values[0]:.8e},{point['mean_distance'].values[1]:.8e},"
        f"{point['difference'].item():.8e},{point['difference_error'].item():.2e},{point['section_distance'].item():.6e},"
        f"{point['event_order_time'].item():.3f},synchronized,synchronized,yes,yes,yes"
    )


def test_altered_data_changes_the_verdict(compare):
    _, dataset = compare({("nonlinear", 0.08): {"mean_distance": 0.2}})
    assert dataset["agrees"].sel(other_law="nonlinear").values.tolist() == [[1, 0]]
    assert dataset["parting_a"].item() == 0.08
    assert dataset["difference"].values[0, 0, 1] == 0.2 - dataset["mean_distance"].values[0, 0, 1]
    words = "they agree at 1 of 2 values of a and disagree at a = 0.08"
    settled = "minus, nonlinear law: the run has not reached the attractor of its initial state at a = 0.08"
    assert agreement.digest(dataset).endswith(f": {words}; the kind of motion differs at 1.\n{settled}\n")
    _, dataset = compare({("nonlinear", a): {"mean_distance": 0.2} for a in (0.05, 0.08)})
    text = "they agree at 0 of 2 values of a and disagree first at a = 0.05 and last at 0.08"
    assert text in agreement.digest(dataset)
    # Laws may agree again beyond the first value at which they disagree.
    _, dataset = compare({("nonlinear", 0.05): {"mean_distance": 0.2}})
    assert "they agree at 1 of 2 values of a and disagree at a = 0.05" in agreement.digest(dataset)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_the_order_of_events_is_compared_until_the_first_run_ends(compare, law):
    _, dataset = compare({(law, 0.05): {"end_time": 7.0}})
    assert dataset["event_order_time"].values[0, 0, 0] == 7.0


@pytest.mark.parametrize(
    ("mean", "error", "branch", "settled"),
    [
        (0.2, 0.0, 4, 1),
        # Within a hundredth of the larger value, or three errors.
        (0.2019, 0.0, 4, 1),
        (0.2021, 0.0, 4, 0),
        (0.1981, 0.0, 4, 1),
        (0.1979, 0.0, 4, 0),
        (0.213, 0.005, 4, 1),
        (0.23, 0.011, 4, -1),  # undetermined with such large errors
        (0.23, 0.009, 4, 0),
        # The attractor that the state reaches is unknown.
        (0.2, 0.0, -1, -1),
    ],
)
def test_a_run_may_not_reach_the_attractor_of_its_state(read, mean, error, branch, settled):
    dataset = kinds_with(read, 0.2, MotionKind.PERIODIC, mean=mean, error=error, branch=branch)
    assert (dataset["settled"] == settled).all()


@pytest.mark.parametrize(
    ("own", "of_attractor", "mean", "kind"),
    [
        # If the run has reached its attractor, an undetermined kind is taken from the attractor.
        (2, {"kind": 1, "branch": 4, "mean": 0.2}, 0.2, 1),
        (-1, {"kind": 2, "branch": 4, "mean": 0.2}, 0.2, 2),
        (2, {"kind": 1, "branch": 4, "mean": 0.3}, 0.2, 2),
        (2, {"kind": 1, "branch": -1, "mean": 0.2}, 0.2, 2),
        (2, {"kind": 3, "branch": 4, "mean": 0.2}, 0.2, 3),
        (2, {"kind": 4, "branch": 4, "mean": 0.2}, 0.2, 3),
        (1, {"kind": 2, "branch": 4, "mean": 0.2}, 0.2, 2),
        (3, {"kind": 5, "branch": 4, "mean": 0.2}, 0.2, 3),
        (-1, {"kind": 4, "branch": 4, "mean": 1e-9}, 1e-9, 5),
        # If the run differs from the attractor, its own kind is kept.
        (3, {"kind": 1, "branch": 4, "mean": 0.2}, 0.2, 3),
        # The run approaches synchrony; it does not.
        (1, {"kind": 0}, 9e-4, 0),
        (1, {"kind": 0}, 1.1e-3, 1),
        # Under a slow driver all distances are smaller.
        (1, {"kind": 0, "v": 0.01}, 9e-5, 0),
        (1, {"kind": 0, "v": 0.01}, 1.1e-4, 1),
        (-1, {"kind": 0}, np.nan, -1),
    ],
)
def test_the_kind_of_a_run_is_that_of_its_attractor(read, own, of_attractor, mean, kind):
    dataset = kinds_with(read, mean, own, **of_attractor)
    assert (dataset["kind"] == kind).all()
    of_attractor_taken = kind != own or (own, kind) == (2, 2)
    assert of_attractor_taken or np.isnan(dataset["period"]).any() or (dataset["period"] != 40.0).any()


@pytest.mark.parametrize(
    ("own", "of_attractor", "settled"), [(1, 2, 1), (3, 3, 1), (3, 4, 1), (3, 1, 0), (1, 3, 0), (1, -1, 1)]
)
def test_a_run_of_another_kind_is_not_on_the_attractor(read, own, of_attractor, settled):
    dataset = kinds_with(read, 0.2, own, kind=of_attractor, branch=4, mean=0.2)
    assert (dataset["settled"] == settled).all()


def test_a_run_without_result_agrees_with_nothing(compare):
    failed = {"status": "step_limit", "mean_distance": np.nan}
    failed |= {f"crossing_{name}": np.zeros(0) for name in ("time", "velocity", "direction")}
    grid, dataset = compare({("linearized", a): failed for a in (0.05, 0.08)})
    assert (dataset["agrees"] == -1).all()
    assert (dataset["same_kind"] == -1).all()
    assert np.isnan(dataset["section_distance"]).all()
    assert np.isnan(dataset["parting_a"].item())
    words = agreement.digest(dataset)
    reason = "At 2 values of a the comparison is undetermined: a run did not complete.\n"
    assert f"no value of a could be compared. {reason}" in words
    assert agreement.table(dataset).count("undetermined") == 6
    assert (dataset["kind"].sel(law="linearized") == -1).all()
    part = means(*grid).sel(law="linearized")
    assert np.isnan(part["mean_distance"]).all()
    assert (part["synchronized"] == 0).all()
    assert (part["status"] == 1).all()


def of_laws(folder, laws):
    settings = {"transient": 100.0, "window": 100.0, "batches": 2}
    grid = grid_of(folder, ["minus"], {"0.05": 0.05, "0.2": 0.2}, {"laws": laws}, **settings)
    return summarize_kinds(write_points(*grid), attractors_of(grid[0]))


def test_each_law_is_compared_with_the_first(tmp_path):
    laws = {"smooth": {"law": "nonlinear"}, "linearized": {}, "same": {"formula": "1/(1 + a*u)"}}
    dataset = of_laws(tmp_path, laws)
    assert dataset["law"].values.tolist() == list(laws)
    assert dataset["other_law"].values.tolist() == ["linearized", "same"]
    mean = dataset["mean_distance"]
    expected = mean.sel(law=["linearized", "same"]) - mean.sel(law="smooth")
    assert np.array_equal(dataset["difference"], expected)
    same = dataset.sel(other_law="same")
    assert (abs(same["difference"]) < 1e-9).all()
    assert (same["event_order_time"] == 200.0).all()
    assert (same["agrees"] != 0).all()
    lines = agreement.digest(dataset).splitlines()[:2]
    begun = [f"minus, {other} law compared with the smooth law" for other in ("linearized", "same")]
    assert [line.split(":")[0] for line in lines] == begun
    head, *rows = agreement.table(dataset).splitlines()
    assert head.split(",")[2:5] == [f"mean_distance_{law}" for law in laws]
    assert {"difference_linearized", "difference_same", "agrees_same"} <= set(head.split(","))
    assert [row.count(",") for row in rows] == [head.count(",")] * 2


def test_a_single_law_is_not_compared(tmp_path):
    dataset = of_laws(tmp_path, {"linearized": {}})
    assert dataset.sizes["other_law"] == 0
    assert agreement.digest(dataset).startswith("The linearized law is the only one: there is nothing to compare.\n")
    head = "initial,a,mean_distance_linearized,kind_linearized,settled_linearized"
    assert agreement.table(dataset).startswith(f"{head}\nminus,0.05,")
    write_summary(dataset, tmp_path / "agreement.nc")
    summary = open_summary(tmp_path / "agreement.nc")
    assert summary["difference"].shape == (0, 1, 2)
    assert summary["law"].values.tolist() == ["linearized"]


@pytest.mark.parametrize(
    ("means", "errors", "kinds", "agrees"),
    [
        ((1.0, 1.111), (0.0, 0.0), (2, 2), 1),  # a tenth of the larger value
        ((1.111, 1.0), (0.0, 0.0), (2, 2), 1),
        ((1.0, 1.112), (0.0, 0.0), (2, 2), 0),
        # Within three errors of the tolerance, here 0.15, the verdict is undetermined.
        ((1.0, 1.27), (0.03, 0.04), (2, 2), -1),
        ((1.0, 1.28), (0.03, 0.04), (2, 2), 0),
        ((2.0, 2.05), (0.03, 0.04), (2, 2), 1),
        ((2.0, 2.07), (0.03, 0.04), (2, 2), -1),
        ((1.0, 1.0), (0.03, 0.04), (2, 2), -1),
        ((1.0, 1.0), (0.0, np.nan), (2, 2), -1),
        ((0.0, 1e-6), (0.0, 0.0), (0, 0), 1),  # at most the threshold of synchrony
        ((0.0, 2e-6), (0.0, 0.0), (1, 1), 0),
        ((0.0, 3e-7), (3e-7, 0.0), (0, 0), 1),  # synchrony, however slowly it is approached
        ((0.0, 3e-7), (3e-7, 0.0), (1, 1), -1),
        # A torus and a periodic orbit without synchrony count as the same kind.
        ((1.0, 1.0), (0.0, 0.0), (1, 2), 1),
        ((1.0, 1.0), (0.0, 0.0), (0, 1), 0),
        ((1.0, 1.0), (0.0, 0.0), (2, 3), 0),
        ((1.0, 1.0), (0.0, 0.0), (1, -1), -1),
        ((1.0, 1.0), (0.0, 0.0), (-1, -1), -1),
        # These disagree whatever their kinds.
        ((1.0, 1.2), (0.0, 0.0), (1, -1), 0),
        ((1.0, np.nan), (0.0, np.nan), (1, -1), -1),
    ],
)
def test_the_verdict_on_two_runs(means, errors, kinds, agrees):
    # At the second a the first law agrees with itself.
    same = {"mean_distance": 1.0, "mean_distance_error": 0.0, "kind": 3}
    dataset = compared(
        {name: [[value, same[name]] for value in pair] for name, pair in zip(same, (means, errors, kinds), strict=True)}
    )
    assert dataset["agrees"].values.tolist() == [[agrees, 1]]
    assert dataset["same_kind"].values.tolist() == [
        [-1 if -1 in kinds else int(kinds in {(k, k) for k in range(4)} | {(1, 2)}), 1]
    ]
    assert dataset["difference"].values == pytest.approx(np.array([[means[1] - means[0], 0.0]]), nan_ok=True)
    assert dataset["difference_error"].values == pytest.approx(np.array([[np.hypot(*errors), 0.0]]), nan_ok=True)
    assert dataset["parting_a"].values == pytest.approx([0.1 if agrees == 0 else np.nan], nan_ok=True)


def compared(motion):
    """Return the comparison of motions under several laws at a = 0.1, 0.2, …; motion : {variable: [[a, …], …]}."""
    grid = 0.1 * (1.0 + np.arange(len(motion["kind"][0])))
    dataset = xarray.Dataset({name: (("law", "a"), rows) for name, rows in motion.items()}, {"a": grid})
    return compare_laws(dataset, 1e-6, AGREEMENT)


def test_parting_a_is_the_smallest_a_of_disagreement():
    means = [[1.0, 1.0, 1.0], [1.0, 2.0, 3.0], [1.0, 1.0, 3.0]]
    dataset = compared({"mean_distance": means, "mean_distance_error": np.zeros((3, 3)), "kind": np.ones((3, 3), int)})
    assert dataset["agrees"].values.tolist() == [[1, 0, 0], [1, 1, 0]]
    assert dataset["same_mean_distance"].values.tolist() == [[1, 0, 0], [1, 1, 0]]
    assert dataset["parting_a"].values == pytest.approx([0.2, 0.3])
