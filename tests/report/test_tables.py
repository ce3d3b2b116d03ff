"""Tables of the page: where synchrony begins and ends, and where a_c is no end of it."""

import numpy as np
import pytest
import xarray

from burridge_knopoff import Model
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.report.tables import synchrony_table, transition_table
from burridge_knopoff.summaries.orbit_flags import stability_edge
from burridge_knopoff.summaries.orbits import summarize

SYNCHRONIZED, PERIODIC, CHAOTIC = MotionKind.SYNCHRONIZED, MotionKind.PERIODIC, MotionKind.CHAOTIC


def bifurcations(rows):
    """Return bifurcations, 0.01 apart, from rows (change, branches before and after, motions before and after)."""
    names = ("change", "from_branch", "to_branch", "motion_before", "motion_after")
    columns = {
        name: ("bifurcation", np.array(column, "i2")) for name, column in zip(names, np.transpose(rows), strict=True)
    }
    a, count = 0.01 * np.arange(1, len(rows) + 1), len(rows)
    columns |= {"a": ("bifurcation", a), "a_error": ("bifurcation", np.full(count, 1e-10))}
    columns |= {"period": ("bifurcation", np.full(count, 5.36))}
    columns |= {"kind": ("bifurcation", np.full(count, int(BifurcationKind.PITCHFORK), "i1"))}
    return xarray.Dataset({**columns, "law": ("bifurcation", ["linearized"] * count)})


def test_only_changes_of_a_synchronized_branch_are_listed():
    """A branch that begins at the end of synchrony, or leads to it, is another one; what is passed changes nothing."""
    table = synchrony_table(
        bifurcations(
            [
                (Change.BEGINNING, 1, 0, CHAOTIC, SYNCHRONIZED),
                (Change.BEGINNING, 0, 4, SYNCHRONIZED, PERIODIC),
                (Change.PASSED, 0, 0, SYNCHRONIZED, SYNCHRONIZED),
                (Change.END, 1, 0, CHAOTIC, SYNCHRONIZED),
                (Change.CHANGE, 0, 0, SYNCHRONIZED, SYNCHRONIZED),
                (Change.END, 0, 4, SYNCHRONIZED, PERIODIC),
                (Change.END, 1, -1, PERIODIC, MotionKind.UNDETERMINED),
            ]
        )
    )
    assert [row["a"].split()[0][:4] for row in table] == ["0.01", "0.05", "0.06"]
    assert table[2] == {
        "law": "linearized",
        "a": table[2]["a"],
        "kind": "pitchfork",
        "change": "branch 0 ends, synchronized; at larger a it leads to branch 4",
        "period": "5.36",
    }


@pytest.mark.parametrize(
    ("coupling", "words"), [(1.0, "lost"), (1.5, "unstable on both sides: synchrony does not end there"), (2.0, "–")]
)
def test_the_table_says_whether_synchrony_ends_at_a_c(coupling, words):
    """At coupling 2 the transverse multiplier never reaches 1. The chart has a line only at an end of synchrony."""
    orbits = summarize([Model("linearized", a=0.1, coupling=coupling)], [0.1])
    rows = {row["name"]: row["cells"] for row in transition_table(orbits)["rows"]}
    assert rows["stability of the orbit at a_c, as a grows"] == [words]
    assert np.isfinite(stability_edge(orbits.sel(law="linearized"))) == (words == "lost")
