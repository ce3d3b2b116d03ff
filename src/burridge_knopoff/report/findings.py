"""What a study finds about each statement of the paper, in one sentence with one number, for the card of a verdict.

The reason of a verdict has all numbers. A sentence is true whatever the verdict is: it only says what was measured.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from burridge_knopoff.report.numbers import format_measured


class Finding(NamedTuple):
    """A sentence with a place for its number.

    quantity : start of the names of the measured quantities that it is about
    choose : which of their values it gives
    none : the sentence if this value is 0; empty if it is the same
    """

    sentence: str
    quantity: str
    choose: Callable[[Iterable[float]], float] = min
    none: str = ""


#: By the name of the claim. A number before a per cent sign is a share.
FINDINGS = {
    "minus_synchronizes": Finding("They do at {} % or more of these values of a.", "share of a with synchrony"),
    "plus_does_not_synchronize": Finding(
        "They do not at {} % or more of these values of a.", "share of a with no synchrony"
    ),
    "upper_edge": Finding(
        "The synchronized orbit is stable at least up to a = {}.",
        "a_c, at which the synchronized orbit loses stability",
    ),
    "lower_edge": Finding("Synchrony begins near a = {}.", "smallest a with synchrony"),
    "plus_mean_distance": Finding("⟨J⟩ is {} there.", "⟨J⟩"),
    "plus_stationary": Finding("The batch means give ⟨J⟩ = {}.", "⟨J⟩"),
    "minus_distance_vanishes": Finding("J stays below a millionth from τ = {} on.", "time τ from which on J < 1e-06"),
    "history_decides": Finding(
        "Attractors of more than one kind coexist at {} % or more of these values of a.",
        "share of a with attractors of more than one kind",
    ),
    "first_block_decides": Finding(
        "The outcomes of minus and plus differ at {} % or more of these values of a.",
        "share of a at which the outcome differs",
    ),
    "same_for_both_laws": Finding(
        "The outcome is the same at {} % or more of these values of a.", "share of a with the same outcome"
    ),
    "plus_under_one_convention": Finding(
        "No convention makes more than {} of the statements hold.", "claims that hold", max
    ),
    "phases_decide": Finding(
        "At every amplitude {} % or more of the close phases synchronize.",
        "smallest share of close phases that synchronize",
    ),
    "regular_below": Finding(
        "The motion is synchronized, periodic or quasiperiodic at {} % or more of these values of a.",
        "share of a with synchronized, periodic or quasiperiodic motion",
    ),
    "chaotic_above": Finding(
        "It is chaotic at no more than {} % of these values of a.", "share of a with chaotic motion", max
    ),
    "minus_periodic": Finding(
        "The motion is synchronized or periodic at {} % of these values of a.",
        "share of a with synchronized or periodic motion",
    ),
    "periodic_is_synchronized": Finding(
        "It is synchronized at {} % or more of the values of a at which the paper finds synchrony.",
        "share of a with 0.005 ≤ a ≤ 0.08",
    ),
    "transition": Finding("The first chaotic attractor is at a = {}.", "smallest a with a chaotic attractor"),
    "plus_largest_exponent": Finding(
        "It is 0 within its error at {} % of these values of a.", "share of a at which it is 0"
    ),
    "plus_aperiodic": Finding(
        "The motion repeats after {} section points.", "section points in a period", max, "The motion does not repeat."
    ),
    "branch_locked": Finding(
        "Unequal end blocks keep one frequency at {} % or more of these values of a.",
        "share of a at which the end blocks keep one frequency",
    ),
    "locking_precedes_chaos": Finding(
        "A periodic orbit to which a torus has locked precedes no more than {} % of the onsets of chaos.",
        "share of the onsets of chaos that a periodic orbit to which a torus has locked",
        max,
    ),
    "minus_one_section_point": Finding(
        "The section is one point at {} % of the values of a at which the motion has settled.",
        "share of a with one section point",
    ),
    "plus_cloud": Finding("The section is a cloud at {} % of these values of a.", "share of a with more than"),
    "plus_not_periodic": Finding(
        "Where there is a cloud, the motion is quasiperiodic or chaotic at {} % of the values of a.",
        "share of them with quasiperiodic or chaotic motion",
    ),
    "plus_line_disappears": Finding(
        "No section point is on the line at {} % of these values of a.", "share of a without a point on the line"
    ),
    "velocities_touch_zero": Finding("Each block stops {} times in a unit of time, or more often.", "stops per unit"),
    "not_differentiable_at_events": Finding(
        "U'' jumps by {} or more where a block stops.", "smallest jump of U'' where a block stops"
    ),
    "sticks_unavoidable": Finding(
        "Some block stops on {} % or more of the attractors.", "share of attractors in which some block stops"
    ),
    "antiphase": Finding("The correlation of the two velocities is {}.", "correlation of U₁' and U₃'"),
    "antiphase_persists": Finding(
        "Of the runs in antiphase {} % or more are on their attractor.", "share of the runs in antiphase"
    ),
    "half_frequency": Finding(
        "The ratio of the frequencies is {}.", "frequency of the velocity of block 1 over that of block 2"
    ),
    "cycle_time": Finding(
        "The median time between successive stops of one block is {} or more.",
        "median time between successive stops of one block",
    ),
    "dimensionless_equations": Finding(
        "They differ by no more than {}.", "largest difference", max, "The difference between them is 0."
    ),
    "equilibrium": Finding(
        "It differs from the formula by no more than {}.",
        "largest difference",
        max,
        "The difference from the formula is 0, up to rounding.",
    ),
    "equilibrium_unstable": Finding("The largest real part is {} or more.", "smallest of the largest real parts"),
    "oscillations_grow": Finding(
        "Perturbations grow at {} times −F'(v) or faster.", "smallest growth rate over −F'(v)"
    ),
    "growth_rate": Finding(
        "Perturbations grow at no more than {} times −F'(v).", "largest growth rate over −F'(v)", max
    ),
    "velocities_near_driver": Finding("The largest is {} times v.", "largest initial velocity over v", max),
    "minus_near_equilibrium": Finding("In minus it begins {} from there.", "|U₁(0) − U₁ᵉ|, minus"),
    "friction_keeps_sign": Finding("The smallest friction on a slipping block is {}.", "smallest Φ"),
    "exponentials": Finding("A position has no more than {} exponentials.", "largest number of exponentials", max),
    "map_dimension": Finding(
        "Sticking destroys up to {} of its dimensions for good.", "largest number of exponents of −∞", max
    ),
    "stable_where_friction_grows": Finding(
        "If the slope is reversed, the largest growth rate is {}.", "largest growth rate", max
    ),
    "laws_agree": Finding(
        "Compared with the largest value, ⟨J⟩ agrees at {} % or more of these values of a.",
        "share of a at which the laws agree, of the largest value",
    ),
    "laws_agree_in_kind": Finding(
        "Judged most strictly, the kinds agree at {} % or more of these values of a.",
        "share of a at which the laws agree",
    ),
    "stick_slip_alone": Finding(
        "Both laws have the same result at {} % or more of these values of a.",
        "share of a at which the laws have the same result",
    ),
    "linearization_justified": Finding(
        "The laws differ by no more than {} % of the static friction.", "largest difference of the laws", max
    ),
    "springs_and_masses_help": Finding(
        "The difference of ⟨J⟩ between the laws falls as a^{} or faster.", "power of a with which the difference of ⟨J⟩"
    ),
    "low_friction_helps": Finding(
        "The difference of ⟨J⟩ between the laws falls as a^{} or faster.", "power of a with which the difference of ⟨J⟩"
    ),
    "two_blocks_agree": Finding(
        "The laws agree in the kind of motion and in ⟨J⟩ at {} % of these values of a.",
        "share of a at which the laws agree in the kind of motion and in ⟨J⟩",
    ),
    "periodic_for_one_block": Finding(
        "One block sticks and slips periodically at {} % of the values of a.",
        "share of a at which one block sticks and slips periodically",
    ),
    "solutions_agree": Finding(
        "The solutions agree at {} % or more of what was compared.", "share with agreement of the"
    ),
    "map_is_cheaper": Finding(
        "The paper's time stepping takes {} times as many steps.", "ratio of these to those of the map, the paper's"
    ),
}


def finding(claim: Mapping[str, Any]) -> str:
    """Return what was found about a claim, as in claims.json; the first sentence of its reason if it has no number."""
    entry = FINDINGS.get(claim["name"])
    values = [
        item["value"]
        for item in claim["measured"]
        if entry and item["value"] is not None and item["quantity"].startswith(entry.quantity)
    ]
    if not entry or not values:
        return re.split(r"(?<=[.!?]) (?=[A-Z])", claim["reason"])[0]
    value = entry.choose(values) * (100.0 if "{} %" in entry.sentence else 1.0)
    number = format_measured(value, digits=3)
    words = entry.none if number == "0" and entry.none else entry.sentence.format(number)
    return words.replace("100 % or more", "100 %")
