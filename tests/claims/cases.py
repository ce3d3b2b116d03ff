"""Alterations of data for which the paper is right, and the resulting verdict on each claim."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING, UNDECIDED
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.running.status import Status
from tests.claims.alterations import (
    CHAOTIC,
    ONE_OF_MANY,
    PERIODIC,
    QUASIPERIODIC,
    TRANSIENT,
    UNDETERMINED,
    Alteration,
    alter,
    attracting,
    both,
    chaos_from,
    cloud,
    crossing,
    everywhere,
    exponents,
    failed,
    few,
    few_points,
    growing,
    line_from,
    locked,
    lost_at,
    means_apart,
    no_crossings,
    parted,
    reached,
    repeating,
    results_apart,
    slips,
    solutions,
    synchronized,
    third_exponent,
)

#: The paper's contact with the other start, and the other contact, which does not decide.
OTHER, SYMMETRIC = {"start": "tested"}, {"contact": "symmetric"}
PERIODIC_PLUS = alter("agreement", "kind", PERIODIC, initial="plus")
ONE_OF_MINUS = {"a": ONE_OF_MANY, "initial": "minus"}
UNKNOWN_ABOVE = reached(-1, initial="minus", a=lambda a: (a > 0.081) & (a < 0.145))
UNREPEATED = alter("lyapunov", "section_period", 0, a=ONE_OF_MANY)
PARTED = alter("two_blocks", "agrees", 0, state=0)
ONE_ATTRACTOR = both(alter("attractors", "branch", 0, a=ONE_OF_MANY), reached(0, a=ONE_OF_MANY))
#: Attractors with a cloud at nine values of a only, at one of which the motion is periodic.
FEW_CLOUDS = both(
    alter("attractors", "section_count", 1, attractor=1, a=lambda a: a > 0.0351),
    alter("attractors", "kind", PERIODIC, attractor=1, a=ONE_OF_MANY),
)
#: Claims that follow from the springs and from F'(v) alone.
THEORY = ("equilibrium_unstable", "oscillations_grow", "growth_rate", "exponentials", "stable_where_friction_grows")
CHAOS_OF_RUNS = alter("agreement", "kind", CHAOTIC, law="nonlinear")
CASES: list[tuple[str, str, Alteration]] = [
    ("minus_synchronizes", FAILS, both(synchronized(0, initial="minus"), reached(1, initial="minus"))),
    ("minus_synchronizes", FAILS, both(synchronized(0, initial="minus", law="nonlinear"), reached(1, initial="minus"))),
    ("minus_synchronizes", CONVENTION, reached(1, initial="minus", **OTHER)),
    ("minus_synchronizes", HOLDS, reached(1, initial="minus", **SYMMETRIC)),
    ("minus_synchronizes", FAILS, both(synchronized(0, initial="minus"), reached(1, initial="minus", **OTHER))),
    # Unknown outcomes, of runs or under another convention, would decide.
    (
        "minus_synchronizes",
        NOT_TESTABLE,
        alter("mean_distance", "status", Status.DIVERGED, initial="minus", a=lambda a: a > 0.02),
    ),
    (
        "minus_synchronizes",
        NOT_TESTABLE,
        both(reached(-1, initial="minus", a=lambda a: a > 0.02, **OTHER), reached(1, initial="minus", a=0.02, **OTHER)),
    ),
    ("minus_synchronizes", HOLDS, reached(-1, initial="minus", **SYMMETRIC)),
    # One law is unknown under another convention: it matters unless the other law fails there.
    ("minus_synchronizes", NOT_TESTABLE, reached(-1, initial="minus", law="linearized", **OTHER)),
    (
        "minus_synchronizes",
        CONVENTION,
        both(
            reached(-1, initial="minus", law="linearized", **OTHER),
            reached(1, initial="minus", law="nonlinear", **OTHER),
        ),
    ),
    ("minus_synchronizes", CONVENTION, synchronized(0, initial="minus")),
    ("upper_edge", LOOSELY, both(reached(0, initial="minus", a=lambda a: a < 0.087), lost_at(0.0887))),
    # Synchrony does not end at a loss of stability elsewhere.
    ("upper_edge", HOLDS, lost_at(0.12)),
    ("upper_edge", HOLDS, lost_at(np.nan)),
    ("upper_edge", FAILS, reached(1, initial="minus", a=lambda a: a > 0.05)),
    ("upper_edge", FAILS, reached(1, initial="minus", law="nonlinear", a=lambda a: a > 0.05)),
    # Synchrony that appears up to an a may reach further, also beyond the grid.
    ("upper_edge", READING, reached(0, initial="minus", a=lambda a: a < 0.145)),
    ("upper_edge", READING, reached(0, initial="minus")),
    ("upper_edge", UNDECIDED, both(UNKNOWN_ABOVE, lost_at(np.nan))),
    ("upper_edge", NOT_TESTABLE, reached(1, initial="minus")),
    ("lower_edge", HOLDS, reached(1, initial="minus", a=lambda a: a < 0.0049)),
    ("lower_edge", UNDECIDED, reached(1, initial="minus", a=lambda a: a < 0.0051)),
    ("lower_edge", FAILS, reached(1, initial="minus", a=lambda a: a < 0.0101)),
    ("lower_edge", FAILS, reached(1, initial="minus", a=lambda a: a < 0.03)),
    ("lower_edge", FAILS, reached(1, initial="minus", law="nonlinear", a=lambda a: a < 0.03)),
    # Synchrony that appears from an a on may begin before; both ends are read in the same two ways.
    ("lower_edge", READING, reached(0, initial="minus", a=0.0025)),
    ("lower_edge", READING, reached(0, initial="minus", a=0.0025, law="nonlinear")),
    ("lower_edge", NOT_TESTABLE, reached(1, initial="minus")),
    # A value of a at which synchrony is not known leaves both possibilities open.
    ("lower_edge", UNDECIDED, reached(-1, initial="minus", a=lambda a: a < 0.0201)),
    ("plus_does_not_synchronize", FAILS, both(synchronized(1, initial="plus"), reached(0, initial="plus"))),
    ("plus_does_not_synchronize", CONVENTION, reached(0, initial="plus", **OTHER)),
    ("plus_does_not_synchronize", LOOSELY, synchronized(1, initial="plus", a=0.005)),
    ("plus_mean_distance", FAILS, both(alter("mean_distance", "mean_distance", 0.2), reached(0, initial="plus"))),
    ("plus_mean_distance", LOOSELY, alter("mean_distance", "mean_distance", 0.147)),
    ("plus_mean_distance", CONVENTION, reached(0, initial="plus", **OTHER)),
    ("plus_stationary", FAILS, both(synchronized(1, initial="plus"), reached(0, initial="plus"))),
    ("plus_stationary", CONVENTION, alter("agreement", "settled", 0, initial="plus")),
    ("plus_stationary", CONVENTION, reached(0, initial="plus", **OTHER)),
    ("plus_stationary", NOT_TESTABLE, reached(-1, initial="plus", **OTHER)),
    ("plus_stationary", HOLDS, reached(-1, initial="plus", **SYMMETRIC)),
    ("plus_stationary", NOT_TESTABLE, alter("agreement", "settled", -1, initial="plus")),
    ("plus_stationary", NOT_TESTABLE, alter("mean_distance", "status", 1)),
    ("minus_distance_vanishes", FAILS, alter("mean_distance", "settling_time", 8000.0)),
    ("minus_distance_vanishes", FAILS, alter("mean_distance", "settling_time", np.nan)),
    ("minus_distance_vanishes", NOT_TESTABLE, alter("mean_distance", "status", 1)),
    ("minus_distance_vanishes", NOT_TESTABLE, alter("mean_distance", "distance_rounding", 1e-6)),
    ("minus_distance_vanishes", FAILS, alter("mean_distance", "settling_time", 4500.0)),
    ("history_decides", HOLDS, alter("attractors", "basin_count", 0, attractor=[1, 2])),
    ("history_decides", FAILS, both(alter("attractors", "branch", 0), reached(0))),
    # An attractor that no state reaches does not count.
    ("history_decides", FAILS, both(alter("attractors", "basin_count", 0, attractor=[1, 2]), reached(0))),
    # Two attractors decide, however few states were sampled.
    (
        "history_decides",
        HOLDS,
        both(
            alter("attractors", "basin_count", 10),
            alter("attractors", "branch", -1, attractor=2),
            reached(0, initial="minus"),
        ),
    ),
    # Several attractors of one kind have one character of motion; an undetermined kind does not count.
    ("history_decides", FAILS, alter("attractors", "kind", PERIODIC)),
    ("history_decides", FAILS, both(alter("attractors", "kind", UNDETERMINED, attractor=[1, 2]))),
    ("history_decides", LOOSELY, ONE_ATTRACTOR),
    ("history_decides", NOT_TESTABLE, both(ONE_ATTRACTOR, alter("attractors", "basin_count", 20))),
    ("first_block_decides", FAILS, both(synchronized(1, initial="plus"), reached(0, initial="plus"))),
    ("first_block_decides", CONVENTION, reached(0, initial="plus", **OTHER)),
    (
        "first_block_decides",
        NOT_TESTABLE,
        alter("mean_distance", "status", Status.DIVERGED, initial="minus", a=lambda a: a > 0.02),
    ),
    # Under the first law only.
    ("first_block_decides", CONVENTION, reached(0, initial="plus", law="linearized", **OTHER)),
    ("first_block_decides", NOT_TESTABLE, reached(-1, initial="minus", **OTHER)),
    ("first_block_decides", HOLDS, reached(-1, initial="minus", **SYMMETRIC)),
    ("same_for_both_laws", FAILS, both(synchronized(1, initial="plus", law="nonlinear"), reached(0, law="linearized"))),
    ("same_for_both_laws", CONVENTION, synchronized(1, initial="plus", law="nonlinear")),
    # From the first state only.
    ("same_for_both_laws", CONVENTION, reached(1, initial="minus", law="linearized", **OTHER)),
    ("phases_decide", FAILS, alter("phases", "branch", 2, phase_difference=30.0)),
    ("phases_decide", FAILS, alter("phases", "velocity_correlation", 1.0, phase_difference=180.0)),
    # Phases that are neither close nor opposite.
    ("phases_decide", HOLDS, alter("phases", "velocity_correlation", 1.0, phase_difference=150.0)),
    # At amplitudes at which blocks stop during an oscillation, of which the paper may or may not speak.
    ("phases_decide", READING, alter("phases", "branch", 2, phase_difference=30.0, amplitude=0.2)),
    ("phases_decide", READING, alter("phases", "velocity_correlation", 1.0, phase_difference=180.0, amplitude=0.2)),
    ("phases_decide", LOOSELY, alter("phases", "branch", 2, phase_difference=30.0, a=ONE_OF_MANY)),
    # Two of eighty states do not contradict the claim, twenty do.
    ("phases_decide", HOLDS, alter("phases", "branch", 2, phase_difference=[15.0, 30.0], state=1)),
    ("phases_decide", FAILS, alter("phases", "branch", 2, phase_difference=[15.0, 30.0], state=np.arange(1, 11))),
    ("phases_decide", HOLDS, alter("phases", "branch", 2, a=lambda a: a > 0.08)),
    # The paper does not mention the inner block: a verdict that depends on its motion depends on the reading.
    ("phases_decide", READING, alter("phases", "branch", 2, phase_difference=30.0, inner_share=1.0)),
    (
        "phases_decide",
        READING,
        alter("phases", "velocity_correlation", 1.0, phase_difference=180.0, inner_share=0.3),
    ),
    ("phases_decide", HOLDS, alter("phases", "slipping_amplitude", 0.001, inner_share=1.0)),
    # A motion of the inner block that cannot be judged does not hide the next one.
    (
        "phases_decide",
        READING,
        both(
            alter("phases", "slipping_amplitude", 0.001, inner_share=0.3),
            alter("phases", "branch", 2, phase_difference=30.0, inner_share=1.0),
        ),
    ),
    ("phases_decide", READING, alter("phases", "branch", 2, phase_difference=30.0, inner_share=0.0)),
    ("phases_decide", NOT_TESTABLE, lambda world: world.update(phases=world["phases"].sel(inner_share=[0.3, 1.0]))),
    ("phases_decide", NOT_TESTABLE, alter("phases", "slipping_amplitude", 0.001)),
    ("phases_decide", UNDECIDED, few("phases", state=15)),
    ("regular_below", FAILS, everywhere("agreement", "kind", CHAOTIC)),
    ("regular_below", CONVENTION, alter("agreement", "kind", CHAOTIC)),
    ("regular_below", LOOSELY, alter("agreement", "kind", CHAOTIC, a=ONE_OF_MANY)),
    ("chaotic_above", FAILS, everywhere("agreement", "kind", PERIODIC)),
    ("chaotic_above", LOOSELY, alter("agreement", "kind", PERIODIC, a=0.2)),
    ("chaotic_above", HOLDS, alter("agreement", "kind", UNDETERMINED, a=0.2)),
    # Undetermined kinds of most runs would decide.
    ("chaotic_above", NOT_TESTABLE, alter("agreement", "kind", UNDETERMINED, a=lambda a: a > 0.13)),
    ("transition", FAILS, chaos_from(0.135)),
    ("transition", FAILS, chaos_from(0.05)),
    ("transition", FAILS, chaos_from(9.0)),
    ("transition", LOOSELY, chaos_from(0.115)),
    # The step of the grid between the last value without chaos and the first with it leaves both verdicts open.
    ("transition", UNDECIDED, chaos_from(0.12)),
    ("transition", NOT_TESTABLE, few("refined", value=9)),
    # Transient chaos does not count.
    ("transition", FAILS, alter("refined", "kind", TRANSIENT)),
    # The chaos of a run may be transient.
    ("transition", HOLDS, alter("agreement", "kind", CHAOTIC)),
    # The end blocks are locked if they keep one frequency with other masses, a perturbation of their phases decays, and
    # they do not move in one mode.
    ("branch_locked", FAILS, parted()),
    ("branch_locked", FAILS, parted(law="nonlinear", branch=2)),
    ("branch_locked", HOLDS, parted(detuning=0.8)),
    ("branch_locked", HOLDS, parted(detuning=0.1)),
    ("branch_locked", LOOSELY, parted(a=lambda a: (a > 0.03) & (a < 0.036))),
    ("branch_locked", UNDECIDED, parted(a=lambda a: (a > 0.03) & (a < 0.042))),
    ("branch_locked", FAILS, parted(a=lambda a: (a > 0.03) & (a < 0.047))),
    # Blocks that only springs move keep one frequency too, but then three exponents are 0.
    ("branch_locked", FAILS, third_exponent(-1e-4, 1.6e-4)),
    # An exponent that its error does not tell from 0 shows neither a free phase nor a stable one.
    ("branch_locked", NOT_TESTABLE, third_exponent(-8.5e-4, 4.1e-4)),
    ("branch_locked", HOLDS, third_exponent(-8.5e-4, 4.1e-4, lambda a: (a > 0.03) & (a < 0.034))),
    ("branch_locked", HOLDS, third_exponent(-8.5e-4, 2.8e-4)),
    # Where the end blocks have two frequencies it does not matter.
    ("branch_locked", FAILS, both(parted(), third_exponent(-8.5e-4, 4.1e-4))),
    # If they move in one mode they have one frequency, but are not locked.
    ("branch_locked", READING, alter("rotation", "detuned_end_ratio", 0.55)),
    ("branch_locked", READING, alter("rotation", "detuned_end_ratio", 0.55, branch=2, law="linearized")),
    ("branch_locked", HOLDS, alter("rotation", "detuned_end_ratio", 0.55, detuning=0.1)),
    ("branch_locked", FAILS, both(parted(branch=1), alter("rotation", "detuned_end_ratio", 0.55, branch=2))),
    # The ratio alone does not make a mode, nor does the energy.
    (
        "branch_locked",
        HOLDS,
        both(alter("rotation", "detuned_end_ratio", 0.5), alter("rotation", "detuned_end_phase", 150.0)),
    ),
    ("branch_locked", HOLDS, alter("rotation", "detuned_mode_share", 0.97)),
    # They need not be locked to the middle block.
    ("branch_locked", HOLDS, locked(0)),
    ("branch_locked", HOLDS, locked(-1)),
    # Outside the range, and where there is no regular motion on a branch.
    ("branch_locked", HOLDS, parted(a=lambda a: a > 0.1)),
    ("branch_locked", NOT_TESTABLE, alter("rotation", "detuned_exponent", np.nan, branch=2)),
    ("branch_locked", NOT_TESTABLE, lambda world: world.update(rotation=world["rotation"].sel(detuning=[0.8]))),
    # The common frequency of the end blocks at equal masses follows from mirror symmetry and is not locking.
    ("branch_locked", FAILS, both(parted(), alter("stick_slip", "velocity_frequency", 0.17))),
    ("locking_precedes_chaos", FAILS, alter("bifurcations", "motion_before", QUASIPERIODIC)),
    ("locking_precedes_chaos", LOOSELY, alter("bifurcations", "motion_before", QUASIPERIODIC, bifurcation=13)),
    # An orbit too long to be continued may lie in a tongue between tori: one of twelve does not decide, two do.
    ("locking_precedes_chaos", LOOSELY, alter("bifurcations", "kind", BifurcationKind.UNDETERMINED, bifurcation=13)),
    (
        "locking_precedes_chaos",
        UNDECIDED,
        alter("bifurcations", "kind", BifurcationKind.UNDETERMINED, bifurcation=[13, 14]),
    ),
    (
        "locking_precedes_chaos",
        READING,
        both(
            alter("bifurcations", "kind", BifurcationKind.UNDETERMINED, bifurcation=[13, 14]),
            alter("bifurcations", "motion_before", QUASIPERIODIC, bifurcation=[14, 15, 16, 17, 18]),
        ),
    ),
    # Tori in two of twelve cases may be chance.
    (
        "locking_precedes_chaos",
        UNDECIDED,
        alter("bifurcations", "motion_before", QUASIPERIODIC, bifurcation=[14, 15]),
    ),
    # Earlier chaos, a passed bifurcation or undetermined motion before it excludes an onset of chaos.
    ("locking_precedes_chaos", HOLDS, alter("bifurcations", "motion_before", TRANSIENT, bifurcation=13)),
    ("locking_precedes_chaos", HOLDS, alter("bifurcations", "motion_before", UNDETERMINED, bifurcation=13)),
    (
        "locking_precedes_chaos",
        HOLDS,
        both(
            alter("bifurcations", "motion_before", QUASIPERIODIC, bifurcation=13),
            alter("bifurcations", "change", Change.PASSED, bifurcation=13),
        ),
    ),
    ("locking_precedes_chaos", NOT_TESTABLE, alter("bifurcations", "motion_after", PERIODIC)),
    # A branch that ends on another one is an onset of chaos only if the other was not chaotic before.
    ("locking_precedes_chaos", NOT_TESTABLE, both(alter("bifurcations", "change", Change.END), chaos_from(0.04))),
    ("locking_precedes_chaos", HOLDS, both(alter("bifurcations", "change", Change.END), chaos_from(0.3))),
    # Only the first onset is after a torus, or only it is not.
    ("locking_precedes_chaos", READING, chaos_from(0.052)),
    ("locking_precedes_chaos", READING, alter("bifurcations", "motion_before", QUASIPERIODIC, bifurcation=12)),
    # Locking is that of a torus: periodic windows between chaos, and orbits that were never on a torus, show none.
    ("locking_precedes_chaos", READING, chaos_from(0.04)),
    ("locking_precedes_chaos", READING, alter("refined", "kind", PERIODIC)),
    ("locking_precedes_chaos", READING, alter("refined", "kind", PERIODIC, law="nonlinear")),
    ("periodic_is_synchronized", FAILS, everywhere("agreement", "kind", PERIODIC)),
    ("periodic_is_synchronized", CONVENTION, alter("agreement", "kind", PERIODIC)),
    ("periodic_is_synchronized", CONVENTION, alter("agreement", "kind", PERIODIC, law="nonlinear")),
    ("periodic_is_synchronized", LOOSELY, alter("agreement", "kind", PERIODIC, **ONE_OF_MINUS)),
    # The statement is on the periodic solution, that from minus, where the paper finds synchrony.
    ("periodic_is_synchronized", HOLDS, PERIODIC_PLUS),
    ("periodic_is_synchronized", HOLDS, alter("agreement", "kind", PERIODIC, a=lambda a: a > 0.08)),
    # Motion that is not periodic does not count.
    ("periodic_is_synchronized", HOLDS, alter("agreement", "kind", QUASIPERIODIC, a=lambda a: a < 0.07)),
    ("periodic_is_synchronized", NOT_TESTABLE, alter("agreement", "kind", CHAOTIC)),
    ("periodic_is_synchronized", HOLDS, alter("agreement", "kind", UNDETERMINED, **ONE_OF_MINUS)),
    (
        "periodic_is_synchronized",
        NOT_TESTABLE,
        alter("agreement", "kind", UNDETERMINED, initial="minus", a=lambda a: a > 0.03),
    ),
    ("minus_one_section_point", FAILS, alter("lyapunov", "section_period", 2)),
    ("minus_one_section_point", LOOSELY, both(UNREPEATED, alter("agreement", "kind", QUASIPERIODIC, a=ONE_OF_MANY))),
    # Periodic motion whose section points do not repeat yet has not settled.
    ("minus_one_section_point", HOLDS, UNREPEATED),
    ("minus_one_section_point", NOT_TESTABLE, alter("lyapunov", "section_period", 0, a=lambda a: a > 0.03)),
    ("plus_cloud", CONVENTION, cloud(0.0, 0.3)),
    ("plus_cloud", CONVENTION, cloud(1.0, 0.5)),
    ("plus_cloud", FAILS, both(cloud(1.0, 0.5), alter("attractors", "section_velocity_mean", 0.8, attractor=1))),
    # Under another convention the section is of another kind, higher, or empty.
    ("plus_cloud", CONVENTION, alter("attractors", "section_count", 1)),
    ("plus_cloud", CONVENTION, alter("attractors", "section_count", 0, attractor=1)),
    ("plus_cloud", CONVENTION, alter("attractors", "section_velocity_mean", 0.6, attractor=1)),
    ("plus_cloud", NOT_TESTABLE, alter("attractors", "section_count", -1)),
    ("plus_cloud", CONVENTION, no_crossings),
    ("plus_cloud", NOT_TESTABLE, alter("runs", "status", Status.DIVERGED, a=lambda a: a > 0.03)),
    ("plus_line_disappears", HOLDS, line_from(0.1)),
    ("plus_line_disappears", HOLDS, cloud(1.0, -0.1)),
    # One value of 22, three, and half of them.
    ("plus_line_disappears", LOOSELY, line_from(0.095)),
    ("plus_line_disappears", UNDECIDED, line_from(0.085)),
    ("plus_line_disappears", CONVENTION, line_from(0.05)),
    # Under other conventions both states may reach the same attractor.
    ("plus_line_disappears", CONVENTION, reached(1, initial="minus")),
    ("plus_line_disappears", FAILS, both(line_from(0.05), reached(1, initial="minus"))),
    ("plus_line_disappears", NOT_TESTABLE, reached(-1, initial="minus")),
    ("plus_line_disappears", NOT_TESTABLE, crossing(lambda a: a > 0.1)),
    ("plus_largest_exponent", CONVENTION, alter("lyapunov", "lyapunov_exponent", 0.02, exponent=0)),
    ("plus_largest_exponent", CONVENTION, alter("lyapunov", "lyapunov_exponent", -0.02, exponent=0)),
    ("plus_largest_exponent", LOOSELY, alter("lyapunov", "lyapunov_exponent", 0.02, exponent=0, a=ONE_OF_MANY)),
    ("plus_largest_exponent", HOLDS, alter("lyapunov", "lyapunov_error", np.nan, exponent=0, a=ONE_OF_MANY)),
    ("plus_largest_exponent", NOT_TESTABLE, alter("lyapunov", "lyapunov_error", np.nan, a=lambda a: a > 0.03)),
    ("plus_largest_exponent", CONVENTION, alter("attractors", "kind", CHAOTIC)),
    # Three standard errors are allowed.
    ("plus_largest_exponent", HOLDS, exponents(0.002, 0.001)),
    ("plus_largest_exponent", CONVENTION, exponents(0.002, 0.0005)),
    ("plus_largest_exponent", FAILS, both(exponents(0.002, 0.0005), alter("attractors", "kind", CHAOTIC))),
    (
        "plus_aperiodic",
        FAILS,
        both(everywhere("agreement", "kind", PERIODIC), alter("attractors", "section_count", 1)),
    ),
    # Motion that repeats is periodic, also after many section points.
    ("plus_aperiodic", CONVENTION, repeating(48)),
    ("plus_aperiodic", FAILS, both(repeating(48), attracting(48))),
    ("plus_aperiodic", CONVENTION, reached(0, initial="plus", **OTHER)),
    # An unknown attractor, or one of undetermined kind, could change the verdict.
    ("plus_aperiodic", NOT_TESTABLE, reached(-1, initial="plus", **OTHER)),
    ("plus_aperiodic", NOT_TESTABLE, alter("attractors", "kind", UNDETERMINED)),
    ("plus_aperiodic", HOLDS, reached(-1, initial="plus", **SYMMETRIC)),
    # Transient chaos is chaos, as that of a run is.
    ("plus_aperiodic", HOLDS, alter("attractors", "kind", TRANSIENT)),
    ("plus_not_periodic", FAILS, everywhere("agreement", "kind", PERIODIC)),
    # The claim does not apply where there is no cloud, under a convention or at an a.
    ("plus_not_periodic", HOLDS, reached(0, initial="plus", **OTHER)),
    (
        "plus_not_periodic",
        HOLDS,
        both(few_points(lambda a: a < 0.05), alter("agreement", "kind", PERIODIC, a=lambda a: a < 0.05)),
    ),
    ("plus_not_periodic", NOT_TESTABLE, few_points(lambda a: a < 0.1)),
    ("plus_not_periodic", CONVENTION, alter("agreement", "kind", PERIODIC)),
    ("plus_not_periodic", LOOSELY, alter("agreement", "kind", PERIODIC, a=ONE_OF_MANY)),
    ("plus_not_periodic", NOT_TESTABLE, alter("agreement", "kind", UNDETERMINED, a=lambda a: a > 0.03)),
    ("minus_periodic", FAILS, everywhere("agreement", "kind", CHAOTIC)),
    ("velocities_touch_zero", FAILS, everywhere("stick_slip", "stop_rate", 0.0, block=2)),
    ("velocities_touch_zero", NOT_TESTABLE, alter("stick_slip", "stop_rate", np.nan, a=0.08)),
    ("velocities_touch_zero", CONVENTION, alter("attractors", "stop_rate", 0.0, block=2)),
    ("not_differentiable_at_events", FAILS, alter("stick_slip", "stop_jump", 0.0)),
    ("not_differentiable_at_events", FAILS, alter("stick_slip", "start_jump", 0.0, initial="plus", law="nonlinear")),
    ("not_differentiable_at_events", LOOSELY, alter("stick_slip", "start_jump", 0.0, a=ONE_OF_MANY)),
    ("not_differentiable_at_events", NOT_TESTABLE, alter("stick_slip", "stop_jump", np.nan)),
    ("sticks_unavoidable", FAILS, alter("attractors", "stop_rate", 0.0, attractor=1)),
    ("sticks_unavoidable", FAILS, alter("attractors", "stop_rate", 0.0, attractor=0)),
    ("sticks_unavoidable", HOLDS, alter("attractors", "stop_rate", 0.0, block=2)),
    ("sticks_unavoidable", LOOSELY, alter("attractors", "stop_rate", 0.0, a=ONE_OF_MANY)),
    # If one direction does not grow, motion without sticks is possible.
    ("sticks_unavoidable", FAILS, alter("equilibrium", "eigenvalue", -0.1, part="real", mode=6)),
    ("sticks_unavoidable", LOOSELY, alter("equilibrium", "eigenvalue", 0.0, part="real", mode=6, a=ONE_OF_MANY)),
    ("sticks_unavoidable", NOT_TESTABLE, alter("attractors", "branch", -1)),
    ("antiphase", LOOSELY, alter("stick_slip", "velocity_correlation", -0.51)),
    ("antiphase", CONVENTION, alter("stick_slip", "velocity_correlation", -0.49)),
    ("antiphase", CONVENTION, alter("stick_slip", "velocity_correlation", 0.9)),
    ("antiphase", FAILS, everywhere("stick_slip", "velocity_correlation", 0.9)),
    ("antiphase", CONVENTION, reached(0, initial="plus", **OTHER)),
    ("antiphase", HOLDS, reached(2, initial="plus", **OTHER)),
    (
        "antiphase",
        CONVENTION,
        both(reached(2, initial="plus", **OTHER), alter("attractors", "velocity_correlation", 0.3, attractor=2)),
    ),
    ("antiphase", NOT_TESTABLE, alter("attractors", "velocity_correlation", np.nan)),
    # The ends of both ranges.
    ("antiphase", HOLDS, alter("stick_slip", "velocity_correlation", -0.9)),
    ("antiphase", LOOSELY, alter("stick_slip", "velocity_correlation", -0.66)),
    ("antiphase", FAILS, everywhere("stick_slip", "velocity_correlation", 0.0)),
    ("antiphase_persists", FAILS, alter("agreement", "settled", 0, initial="plus")),
    ("antiphase_persists", LOOSELY, alter("agreement", "settled", 0, initial="plus", a=ONE_OF_MANY)),
    ("antiphase_persists", HOLDS, alter("agreement", "settled", -1, a=ONE_OF_MANY)),
    ("antiphase_persists", HOLDS, alter("agreement", "settled", 0, initial="minus")),
    # No antiphase can persist if the blocks are not in antiphase.
    ("antiphase_persists", NOT_TESTABLE, alter("stick_slip", "velocity_correlation", 0.9)),
    ("antiphase_persists", NOT_TESTABLE, alter("agreement", "settled", -1, a=lambda a: a > 0.03)),
    ("half_frequency", FAILS, everywhere("stick_slip", "stop_rate", 0.34)),
    ("half_frequency", LOOSELY, alter("stick_slip", "velocity_frequency", 0.195, block=1)),
    # 0.65 of a frequency is not more or less half of it, nor is 0.37.
    ("half_frequency", FAILS, everywhere("stick_slip", "velocity_frequency", 0.22, block=1)),
    ("half_frequency", FAILS, everywhere("stick_slip", "stop_rate", 0.074, block=3)),
    ("half_frequency", CONVENTION, alter("attractors", "stop_rate", 0.0, block=2)),
    ("half_frequency", HOLDS, alter("stick_slip", "velocity_frequency_error", 0.02, block=2)),
    ("half_frequency", NOT_TESTABLE, alter("stick_slip", "velocity_frequency", np.nan, block=1)),
    ("half_frequency", NOT_TESTABLE, alter("stick_slip", "velocity_frequency", 0.0, block=2)),
    ("plus_under_one_convention", FAILS, everywhere("mean_distance", "mean_distance", 0.2)),
    ("plus_under_one_convention", LOOSELY, everywhere("mean_distance", "mean_distance", 0.147)),
    ("plus_under_one_convention", HOLDS, alter("mean_distance", "mean_distance", 0.2)),
    ("plus_under_one_convention", HOLDS, alter("agreement", "settled", 0, initial="plus")),
    ("plus_under_one_convention", HOLDS, reached(0, initial="plus", **OTHER)),
    ("plus_under_one_convention", NOT_TESTABLE, alter("stick_slip", "stop_rate", np.nan, a=0.08)),
    # A claim that is undecided may hold under one convention. One that is unknown leaves a convention open.
    ("plus_under_one_convention", HOLDS, FEW_CLOUDS),
    ("plus_under_one_convention", FAILS, both(FEW_CLOUDS, alter("mean_distance", "mean_distance", 0.2))),
    (
        "plus_under_one_convention",
        UNDECIDED,
        both(everywhere("mean_distance", "mean_distance", 0.2), reached(-1, initial="plus", **SYMMETRIC)),
    ),
    ("plus_not_periodic", UNDECIDED, FEW_CLOUDS),
    # A cycle may be that of one block, or the time between stops of any.
    ("cycle_time", READING, alter("stick_slip", "cycle_time", 5.7)),
    ("cycle_time", READING, alter("stick_slip", "stop_rate", 1.0)),
    # It may also be that of the middle block from plus, at the a of the figures.
    (
        "cycle_time",
        READING,
        both(
            alter("stick_slip", "cycle_time", 5.7),
            alter("stick_slip", "stop_rate", 1.0),
            alter("stick_slip", "cycle_time", 2.9, a=0.08, initial="plus", block=2),
        ),
    ),
    ("cycle_time", FAILS, both(alter("stick_slip", "cycle_time", 5.7), alter("stick_slip", "stop_rate", 1.0))),
    ("cycle_time", HOLDS, alter("stick_slip", "cycle_time", 5.7, a=lambda a: a > 0.245)),
    ("cycle_time", LOOSELY, alter("stick_slip", "cycle_time", 3.8)),
    ("cycle_time", NOT_TESTABLE, alter("stick_slip", "cycle_time", np.nan)),
    ("equilibrium", FAILS, alter("equilibrium", "equilibrium_position", -0.8, block=1)),
    ("equilibrium", FAILS, alter("equilibrium", "equilibrium_drift", 0.1)),
    ("equilibrium_unstable", FAILS, alter("equilibrium", "eigenvalue", -0.1, part="real", law="nonlinear")),
    ("equilibrium_unstable", FAILS, alter("equilibrium", "eigenvalue", 0.0, part="real", a=0.2)),
    # A positive real part is enough, of one eigenvalue.
    ("equilibrium_unstable", HOLDS, alter("equilibrium", "eigenvalue", 1.0, part="imaginary")),
    ("equilibrium_unstable", HOLDS, alter("equilibrium", "eigenvalue", 0.0, part="real", mode=[1, 2, 3, 4, 5])),
    ("stable_where_friction_grows", FAILS, alter("equilibrium", "strengthening_growth_rate", 0.01, a=0.2)),
    ("stable_where_friction_grows", NOT_TESTABLE, alter("equilibrium", "strengthening_growth_rate", np.nan)),
    ("stable_where_friction_grows", FAILS, alter("equilibrium", "strengthening_growth_rate", 0.0, a=0.2)),
    # Theory needs a single value of a at which friction falls with velocity.
    *((name, HOLDS, few("equilibrium", a=2)) for name in THEORY),
    *((name, NOT_TESTABLE, few("equilibrium", a=1)) for name in THEORY),
    # Oscillations may grow, but not at the rate that the formula states.
    ("oscillations_grow", HOLDS, growing(0.5)),
    ("oscillations_grow", FAILS, growing(-1.0)),
    ("oscillations_grow", FAILS, growing(0.0)),
    ("growth_rate", FAILS, growing(0.5)),
    ("growth_rate", LOOSELY, growing(0.92)),
    ("minus_near_equilibrium", FAILS, alter("equilibrium", "equilibrium_position", 0.5, block=1)),
    ("minus_near_equilibrium", LOOSELY, alter("equilibrium", "equilibrium_position", -0.7, block=1)),
    ("minus_near_equilibrium", LOOSELY, alter("stick_slip", "position_amplitude", 0.1, initial="minus")),
    ("minus_near_equilibrium", FAILS, alter("stick_slip", "position_amplitude", 2.0, initial="minus")),
    ("minus_near_equilibrium", NOT_TESTABLE, alter("stick_slip", "position_amplitude", np.nan)),
    ("friction_keeps_sign", FAILS, alter("mean_distance", "least_friction", -0.1, a=0.3)),
    ("exponentials", FAILS, alter("equilibrium", "eigenvalue", 1.0, part="imaginary")),
    # Six of them, in three complex pairs.
    ("exponentials", READING, alter("equilibrium", "eigenvalue", [1.0, -1.0, 2.0, -2.0, 3.0, -3.0], part="imaginary")),
    ("map_dimension", FAILS, few("equilibrium", block=2)),
    ("map_dimension", LOOSELY, alter("lyapunov", "lyapunov_infinite_count", 1, a=ONE_OF_MANY)),
    ("map_dimension", NOT_TESTABLE, alter("lyapunov", "status", 1)),
    ("map_dimension", NOT_TESTABLE, alter("lyapunov", "lyapunov_infinite_count", -1)),
    ("linearization_justified", FAILS, alter("mean_distance", "window_least_friction", 0.7, a=ONE_OF_MANY)),
    ("linearization_justified", LOOSELY, alter("mean_distance", "window_least_friction", 0.85, a=ONE_OF_MANY)),
    ("linearization_justified", HOLDS, alter("mean_distance", "window_least_friction", 0.7, a=0.2)),
    # The transient does not count.
    ("linearization_justified", HOLDS, alter("mean_distance", "least_friction", 0.7, a=ONE_OF_MANY)),
    ("linearization_justified", NOT_TESTABLE, alter("mean_distance", "status", 1, initial="minus")),
    # The powers of the difference of ⟨J⟩ at a fixed v, and at a fixed velocity V of the driver.
    ("springs_and_masses_help", READING, results_apart(2.0, 0.0)),
    ("springs_and_masses_help", READING, results_apart(0.0, 1.0)),
    ("springs_and_masses_help", FAILS, results_apart(0.4, -1.0)),
    ("springs_and_masses_help", LOOSELY, results_apart(2.0, 0.7)),
    ("springs_and_masses_help", HOLDS, results_apart(0.8, 3.0)),
    ("springs_and_masses_help", NOT_TESTABLE, alter("orbits", "antiphase_difference", np.nan, a=lambda a: a < 0.05)),
    ("springs_and_masses_help", HOLDS, alter("orbits", "antiphase_difference", np.nan, a=ONE_OF_MANY)),
    # The forces may differ as much as before.
    ("springs_and_masses_help", HOLDS, slips(0.0)),
    ("low_friction_helps", READING, results_apart(2.0, 0.0)),
    ("low_friction_helps", FAILS, results_apart(0.4, -1.0)),
    ("low_friction_helps", HOLDS, slips(0.0)),
    ("laws_agree", FAILS, means_apart(lambda a: a > 0.055)),
    # Where ⟨J⟩ is small, a difference that no figure shows exceeds the same fraction of ⟨J⟩.
    ("laws_agree", HOLDS, alter("agreement", "difference", 0.01, initial="plus")),
    (
        "laws_agree",
        READING,
        both(
            alter("agreement", "difference", 0.01, initial="plus", a=lambda a: a < 0.06),
            alter("agreement", "mean_distance", 0.05, initial="plus", a=lambda a: a < 0.06),
        ),
    ),
    ("laws_agree", FAILS, alter("agreement", "difference", 0.02)),
    # Each curve is judged for itself: 20 of 22 values are nine in ten, 19 leave it open, and with 16 it fails.
    ("laws_agree", LOOSELY, means_apart(lambda a: (a > 0.08) & (a < 0.09), initial="plus")),
    ("laws_agree", UNDECIDED, means_apart(lambda a: (a > 0.08) & (a < 0.095), initial="plus")),
    ("laws_agree", FAILS, means_apart(lambda a: (a > 0.072) & (a < 0.096), initial="plus")),
    ("laws_agree", LOOSELY, means_apart(ONE_OF_MANY, initial="plus")),
    ("laws_agree", NOT_TESTABLE, alter("agreement", "difference_error", 0.01, a=lambda a: a > 0.03, initial="plus")),
    ("laws_agree", HOLDS, alter("agreement", "difference_error", 0.01, a=ONE_OF_MANY)),
    # The kind of motion is judged separately.
    ("laws_agree", HOLDS, alter("agreement", "same_kind", 0)),
    ("laws_agree_in_kind", FAILS, alter("agreement", "same_kind", 0, a=lambda a: a > 0.055)),
    ("laws_agree_in_kind", LOOSELY, alter("agreement", "same_kind", 0, a=ONE_OF_MANY, initial="plus")),
    ("laws_agree_in_kind", NOT_TESTABLE, alter("agreement", "same_kind", -1, a=lambda a: a > 0.03, initial="plus")),
    ("laws_agree_in_kind", HOLDS, means_apart(lambda a: a > 0.055)),
    # Periodic and quasiperiodic motion are one kind or two.
    ("laws_agree_in_kind", READING, alter("agreement", "kind", PERIODIC, initial="plus", law="nonlinear")),
    (
        "laws_agree_in_kind",
        LOOSELY,
        alter("agreement", "kind", PERIODIC, initial="plus", law="nonlinear", a=ONE_OF_MANY),
    ),
    (
        "laws_agree_in_kind",
        UNDECIDED,
        alter("agreement", "kind", PERIODIC, initial="plus", law="nonlinear", a=lambda a: (a > 0.08) & (a < 0.092)),
    ),
    # Attractors that exist under one law only, or on which the motion differs; a motionless block; another result of a
    # state.
    ("stick_slip_alone", READING, alter("attractors", "branch", -1, attractor=2, law="nonlinear")),
    ("stick_slip_alone", READING, alter("attractors", "kind", CHAOTIC, attractor=2, law="nonlinear")),
    ("stick_slip_alone", HOLDS, alter("attractors", "kind", PERIODIC, attractor=1, law="nonlinear")),
    ("stick_slip_alone", LOOSELY, alter("attractors", "branch", -1, attractor=2, law="nonlinear", a=ONE_OF_MANY)),
    ("stick_slip_alone", FAILS, alter("attractors", "stop_rate", 0.0, attractor=1)),
    ("stick_slip_alone", FAILS, alter("attractors", "stop_rate", 0.0, attractor=0)),
    ("stick_slip_alone", HOLDS, alter("attractors", "stop_rate", 0.0, block=2)),
    ("stick_slip_alone", READING, alter("agreement", "same_kind", 0, initial="plus")),
    ("stick_slip_alone", LOOSELY, alter("agreement", "same_kind", 0, initial="plus", a=ONE_OF_MANY)),
    ("stick_slip_alone", NOT_TESTABLE, alter("agreement", "same_kind", -1, a=lambda a: a > 0.03)),
    ("stick_slip_alone", NOT_TESTABLE, alter("attractors", "kind", UNDETERMINED, attractor=0)),
    ("stick_slip_alone", NOT_TESTABLE, alter("attractors", "branch", -1, law="linearized")),
    (
        "stick_slip_alone",
        FAILS,
        both(alter("agreement", "same_kind", 0), alter("attractors", "branch", -1, attractor=2, law="nonlinear")),
    ),
    # The kind of motion and ⟨J⟩ are judged separately.
    ("two_blocks_agree", READING, PARTED),
    ("two_blocks_agree", FAILS, both(PARTED, alter("two_blocks", "difference", 0.1, state=0))),
    ("two_blocks_agree", READING, alter("two_blocks", "difference", 0.1, state=0)),
    ("two_blocks_agree", LOOSELY, alter("two_blocks", "difference", 0.1, state=0, a=0.1)),
    # Two values of fourteen leave a reading open.
    ("two_blocks_agree", UNDECIDED, alter("two_blocks", "difference", 0.1, state=0, a=[0.1, 0.12])),
    (
        "two_blocks_agree",
        UNDECIDED,
        both(
            *(
                alter("two_blocks", name, value, a=[0.1, 0.12])
                for name, value in {"difference": 0.1, "agrees": 0}.items()
            )
        ),
    ),
    ("two_blocks_agree", READING, both(PARTED, alter("two_blocks", "agrees", -1, state=1))),
    ("two_blocks_agree", HOLDS, alter("two_blocks", "agrees", -1, state=1, a=0.1)),
    # Where the kind of motion decides, no distance is needed.
    (
        "two_blocks_agree",
        READING,
        both(PARTED, alter("two_blocks", "same_kind", 0, state=0), alter("two_blocks", "margin", -2.0, state=0)),
    ),
    ("two_blocks_agree", HOLDS, alter("two_blocks", "margin", 7.0, a=0.1, state=2)),
    ("two_blocks_agree", NOT_TESTABLE, alter("two_blocks", "agrees", -1, state=1, a=lambda a: a > 0.05)),
    ("two_blocks_agree", HOLDS, alter("two_blocks", "agrees", 0, chain="both_pulled")),
    ("periodic_for_one_block", FAILS, alter("two_blocks", "one_block_kind", QUASIPERIODIC, law="nonlinear")),
    ("periodic_for_one_block", FAILS, alter("two_blocks", "one_block_stop_rate", 0.0)),
    ("periodic_for_one_block", LOOSELY, alter("two_blocks", "one_block_kind", CHAOTIC, a=0.1)),
    ("periodic_for_one_block", FAILS, alter("agreement", "kind", PERIODIC)),
    (
        "periodic_for_one_block",
        HOLDS,
        both(alter("agreement", "kind", PERIODIC), alter("two_blocks", "kind", CHAOTIC, chain="train", a=0.3)),
    ),
    ("periodic_for_one_block", NOT_TESTABLE, alter("two_blocks", "one_block_kind", -1, a=lambda a: a > 0.05)),
    ("solutions_agree", FAILS, alter("solvers", "difference", 0.05, solver="rk4")),
    ("solutions_agree", FAILS, alter("solvers", "difference", 0.001, solver="rk4")),
    # A thousandth of ⟨J⟩, three standard errors, or the threshold of synchrony are allowed.
    ("solutions_agree", HOLDS, solutions(1.3e-4)),
    ("solutions_agree", FAILS, solutions(1.5e-4)),
    ("solutions_agree", HOLDS, solutions(2.9e-4, error=1e-4)),
    ("solutions_agree", FAILS, solutions(3.1e-4, error=1e-4)),
    ("solutions_agree", HOLDS, solutions(1e-6, mean=0.0, error=0.0)),
    ("solutions_agree", FAILS, solutions(1.1e-6, mean=0.0, error=0.0)),
    # Under another convention the laws may lead to the same result.
    ("solutions_agree", CONVENTION, CHAOS_OF_RUNS),
    ("solutions_agree", CONVENTION, alter("agreement", "kind", PERIODIC, law="nonlinear", initial="minus")),
    # Whether other regular motion is periodic or not does not count as another result.
    (
        "solutions_agree",
        HOLDS,
        alter("agreement", "kind", PERIODIC, law="nonlinear", initial="plus", a=lambda a: a < 0.1),
    ),
    # Above 0.1 the laws may lead to other results; the abstract's sentence may be about them as well.
    ("solutions_agree", READING, alter("agreement", "kind", PERIODIC, law="nonlinear", a=lambda a: a > 0.1)),
    ("solutions_agree", LOOSELY, alter("agreement", "kind", PERIODIC, law="nonlinear", a=[0.2, 0.21])),
    ("solutions_agree", NOT_TESTABLE, alter("agreement", "kind", UNDETERMINED, a=lambda a: a > 0.12)),
    # The laws are compared at every a: one of twenty-two does not contradict the claim.
    ("solutions_agree", LOOSELY, alter("agreement", "kind", CHAOTIC, law="nonlinear", a=ONE_OF_MANY)),
    # If solvers differ at one of six points, these are too few to decide.
    ("solutions_agree", UNDECIDED, alter("solvers", "difference", 0.05, a=0.02, initial="plus", solver="rk4")),
    ("solutions_agree", NOT_TESTABLE, alter("agreement", "kind", UNDETERMINED, a=lambda a: a > 0.05)),
    ("solutions_agree", FAILS, both(CHAOS_OF_RUNS, alter("attractors", "kind", CHAOTIC, law="nonlinear"))),
    ("solutions_agree", NOT_TESTABLE, both(CHAOS_OF_RUNS, alter("attractors", "kind", UNDETERMINED))),
    ("solutions_agree", NOT_TESTABLE, lambda world: world.update(solvers=world["solvers"].sel(a=[0.08]))),
    ("solutions_agree", HOLDS, lambda world: world.update(solvers=world["solvers"].sel(a=[0.02, 0.08]))),
    # Two solvers of a law are enough.
    ("solutions_agree", HOLDS, lambda world: world.update(solvers=world["solvers"].sel(solver=["series", "rk4"]))),
    ("solutions_agree", NOT_TESTABLE, alter("agreement", "kind", UNDETERMINED)),
    ("solutions_agree", NOT_TESTABLE, alter("solvers", "difference", np.nan)),
    # A failed run does not agree with any other.
    ("solutions_agree", NOT_TESTABLE, failed("rk4")),
    ("solutions_agree", NOT_TESTABLE, both(failed("rk4"), failed("map", law="linearized"))),
    ("solutions_agree", HOLDS, failed("rk4", a=0.02)),
    ("solutions_agree", HOLDS, alter("agreement", "kind", UNDETERMINED, a=0.02)),
    ("map_is_cheaper", FAILS, alter("solvers", "step_count", 10**9)),
    # Only the paper's time stepping decides, a million steps per unit time.
    ("map_is_cheaper", HOLDS, alter("solvers", "step_count", 10_000, solver=["series", "rk4"])),
    ("map_is_cheaper", HOLDS, alter("solvers", "step_count", 10**7, solver="map")),
    ("map_is_cheaper", LOOSELY, alter("solvers", "step_count", 10_000_001, solver="map")),
    ("map_is_cheaper", LOOSELY, alter("solvers", "step_count", 10**8, solver="map")),
    ("map_is_cheaper", FAILS, alter("solvers", "step_count", 100_000_001, solver="map")),
]
