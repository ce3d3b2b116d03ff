"""Numbers in netCDF files keep their meaning, so that old files remain readable."""

import pytest

from burridge_knopoff import MotionKind, Symmetry
from burridge_knopoff.basins.uncertainty import ExponentKind
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.chain_synchronization import Outcome
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries.orbit_flags import BifurcationSide, OrbitStatus


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        (Answer, {-1: "undetermined", 0: "no", 1: "yes"}),
        (
            Status,
            {-2: "halted", -1: "full", 0: "completed", 1: "step_limit", 2: "accumulating_events", 3: "diverged"},
        ),
        (
            MotionKind,
            {-1: "undetermined", 0: "synchronized", 1: "periodic", 2: "quasiperiodic"}
            | {3: "chaotic", 4: "transient_chaos", 5: "synchronized_chaos"},
        ),
        (Symmetry, {0: "synchronized", 1: "symmetric", 2: "asymmetric"}),
        (
            BifurcationKind,
            {-1: "undetermined", 0: "grazing", 1: "fold", 2: "period_doubling"}
            | {3: "neimark_sacker", 4: "pitchfork", 5: "crisis"},
        ),
        (OrbitStatus, {0: "found", 1: "neutral", 2: "not_found", 3: "not_three_blocks"}),
        (BifurcationSide, {-1: "undetermined", 0: "subcritical", 1: "supercritical"}),
        (Outcome, {-1: "undetermined", 0: "not_synchronized", 1: "synchronized"}),
        (ExponentKind, {-1: "unknown", 0: "varying", 1: "single"}),
        (Change, {0: "beginning", 1: "end", 2: "change", 3: "passed"}),
    ],
)
def test_numbers_keep_their_meaning(kind, names):
    """There may be more of them."""
    assert names.items() <= {member.value: member.name.lower() for member in kind}.items()
