"""Meanings of the flag variables in every file; changing them would break programs that read the files."""

import importlib

import pytest

YES_NO = {0: "no", 1: "yes"}
STATUS = {0: "completed", 1: "step_limit", 2: "accumulating_events", 3: "diverged"}
MOTION = {
    **{-1: "undetermined", 0: "synchronized", 1: "periodic", 2: "quasiperiodic", 3: "chaotic"},
    **{4: "transient_chaos", 5: "synchronized_chaos", 6: "sliding"},
}
BIFURCATION = {
    -1: "undetermined",
    0: "grazing",
    1: "fold",
    2: "period_doubling",
    3: "neimark_sacker",
    4: "pitchfork",
    5: "crisis",
    6: "hopf",
}
DIRECTION = {-1: "downward", 1: "upward"}
VERDICT = {-1: "undetermined", **YES_NO}
AGREEMENT = {"kind": MOTION, **dict.fromkeys(("same_kind", "same_mean_distance", "agrees"), VERDICT)}
SLOT = {
    "symmetry": {-1: "none", 0: "synchronized", 1: "symmetric", 2: "asymmetric"},
    "kind": MOTION,
    "slow": {-1: "none", **YES_NO},
}
EXPECTED = {
    "runs": {**dict.fromkeys(("mirror_symmetric", "settles", "drifts", "stops"), YES_NO), "status": STATUS},
    "agreement": {**AGREEMENT, "settled": VERDICT},
    "attractors": {**SLOT, "sliding_attracts": YES_NO},
    "refined": {**SLOT, "in_grid": YES_NO},
    "bifurcation_diagram": {"crossing_direction": DIRECTION, "status": STATUS},
    "chains": {"outcome": {-1: "undetermined", 0: "not_synchronized", 1: "synchronized"}},
    "bifurcations": {
        "kind": BIFURCATION,
        "change": {0: "beginning", 1: "end", 2: "change", 3: "passed"},
        "motion_before": MOTION,
        "motion_after": MOTION,
        "turns": VERDICT,
        "orbit_stable": VERDICT,
        "torus_kind": MOTION,
        "torus_end": BIFURCATION,
    },
    "lyapunov": {"run_kind": MOTION, "unstable": YES_NO, "status": STATUS},
    "mean_distance": {"synchronized": YES_NO, "status": STATUS},
    "orbits": {
        "status": {0: "found", 1: "neutral", 2: "not_found", 3: "not_three_blocks"},
        "bifurcation_kind": BIFURCATION,
        "bifurcation_side": {-1: "undetermined", 0: "subcritical", 1: "supercritical"},
        "attracts_within_synchrony": VERDICT,
        "critical_stability": {-1: "undetermined", 0: "unstable", 1: "lost", 2: "gained"},
    },
    "solvers": {"status": {-1: "no_such_solver", **STATUS}},
    "two_blocks": {**AGREEMENT, "one_block_kind": MOTION},
    "stick_slip": {},
    "equilibrium": {},
}


@pytest.mark.parametrize("name", EXPECTED)
def test_flags(name):
    variables = importlib.import_module(f"burridge_knopoff.summaries.{name}").VARIABLES
    assert {key for key, item in variables.items() if "flag_values" in item.attributes} == set(EXPECTED[name])
    for key, item in variables.items():
        # Longer names do not fit on the axis of a plot by xarray; `comment` has the sentence.
        assert 0 < len(item.all_attributes()["long_name"]) <= 40
        assert ("units" in item.all_attributes()) == (key not in EXPECTED[name] and item.dtype != "U")
    for key, meanings in EXPECTED[name].items():
        values, words = (variables[key].attributes[part] for part in ("flag_values", "flag_meanings"))
        assert (variables[key].dtype, values.dtype) == ("i1", "i1")
        assert list(zip(values.tolist(), words.split(), strict=True)) == list(meanings.items())
