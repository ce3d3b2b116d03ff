"""What the search for attractors decides by itself: numbers that no study sets, each with why it has its value.

Times are in units of the transient or the window of `SearchSettings`, distances in units of its resolution where that
is said; all others are for v = 0.1 and grow with v.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tuning:
    """Limits and margins of the search for attractors, and of what matches them along a and between laws."""

    # When a motion has settled.

    #: Longest transient and window, in those of the settings, of a motion that is still settling: four doublings.
    patience: int = 16
    #: Drift, in resolutions, up to which a motion that has not settled by then is followed on, for as many times the
    #: `time_limit` in the longest wait: either it comes to rest, or it is undetermined.
    loose_drift: float = 10.0
    #: What drifts by less than this share of the tolerance within which it repeats does not drift.
    still: float = 1e-3
    #: Part of the resolution that a closed orbit may still be away when it counts as reached.
    left: float = 0.1
    #: Closed orbits drift by less than the resolution over this once they have settled, since they attract
    #: exponentially; other sets fill up so slowly that the resolution itself must do.
    closed_drift: float = 100.0
    #: Window, in that of the settings, of a motion that is not a closed orbit: near a resonance half of a torus looks
    #: like a set of its own until it has filled.
    filling: int = 4
    #: Transients for which a motion that touches its mirror image is followed, to see whether it covers it: at the
    #: default settings about 100 000 time units, ten times as long as a run of the paper.
    lasting: int = 33
    #: A torus may be locked if its motion was nearer to its last return, by this factor, than at any later time.
    much_nearer: float = 0.1
    #: It is locked to a stable orbit that it approaches, and lies no farther from, for v = 0.1.
    locked: float = 0.03
    #: A window that has to distinguish weak chaos from motion on a torus is this many times longer: an exponent of
    #: 0.001 is then beyond its error. In one four times longer closed orbits that hardly attract have not closed.
    longer_window: float = 20.0
    #: On a torus perturbations grow in proportion to time at most, and the logarithm of what they gain in a window
    #: hardly exceeds this share of what that makes; in chaos it grows with the window. In a window so many times longer
    #: as the third number says motion is regular below that share, and chaotic above the second number. In between
    #: longer windows decide; with a window of 0 they always do. Of 583 tori and locked tori one gained more than 3.6
    #: there, 18 on an orbit longer than the window; of 53 chaotic motions with exponents below 0.002 four gained less
    #: than 1.4, all with exponents below 2.2e-4.
    regular_growth: float = 0.5
    chaotic_growth: float = 20.0
    growth_window: float = 4.0
    #: In a window so many times longer exponents of 3e-5 are beyond their error.
    longest_window: float = 100.0

    # When two sets of returns are one.

    #: Share of the returns that must lie near another set: a few may lie where the other has a gap.
    near_share: float = 0.95
    #: Sets are one if they are no farther apart than this many times the distance between neighbours within them, which
    #: varies from place to place.
    spacings: float = 3.0
    #: Share in all stops by which a pair of mirror blocks differs at most between two parts of one motion.
    same_stops: float = 0.03
    #: Error of ⟨J⟩, as a share of it, above which what is no chaos may be on its way to another motion.
    unsteady: float = 0.02
    #: Fewer returns than this show no set.
    fewest_returns: int = 8
    #: A block hardly ever stops if its stops, and those of its mirror image, are less than this share of those of the
    #: blocks that stop the most: what is seen only then is not seen in every window.
    seldom: float = 0.1
    #: ⟨J⟩ of an attractor that is followed once more may differ by this beyond its errors.
    same_mean: float = 1e-3

    #: Distance, for v = 0.1, within which sets at neighbouring values of a are one branch. In the paper's study what
    #: follows smoothly moves by at most 0.007 a step, what is locked in turn to other orbits by at most 0.036, and sets
    #: that coexist are farther apart than 0.04 but for orbits born from one another.
    same_set: float = 0.03
    #: Longest period of a closed orbit that is no torus where changes along a are looked for; `Refine` sets it.
    longest_followed: float = 500.0
    #: Steps of the grid of a for which an attractor that has vanished is remembered: a number that it had is its own
    #: again where a window of another motion lies between.
    remembered: float = 2.0
    #: Returns of a set, spread over all, that are compared with another set.
    compared_returns: int = 150

    #: Steps in which one friction law is turned into another, and values of a at which each branch is followed so.
    law_steps: int = 16
    law_tries: int = 3

    # Whether a motion attracts, and from how far.

    #: Largest radius, where returns are no farther apart: beyond it a push may leave the basin of a thin attractor
    #: although all samples come back.
    largest_radius: float = 0.02
    #: Part of the way to another attractor that a radius takes at most: less than half, so that no state is near both.
    shared: float = 0.4
    #: Least radius of an attractor, 1 % of the default resolution: what comes back only from nearer belongs to a set
    #: that attracts as a whole, or to none.
    smallest_radius: float = 1e-5
    #: Least radius of a closed orbit for which no such set is found. On some orbits a block almost sticks, or almost
    #: starts: they attract from one side only, and hardly at all from the other.
    tiny_radius: float = 1e-8
    #: Pushed trajectories have come back when they are this many times closer than they were pushed, well beyond what a
    #: motion that neither attracts nor repels shows.
    recovery: float = 10.0
    #: The same for synchrony whose multipliers say that it attracts, near where it loses its stability: perturbations
    #: shrink there at a rate that vanishes, and their third powers alone bring them closer.
    slow_recovery: float = 2.0
    #: The next radius that is tried is smaller by this factor.
    shrinking: float = 2.0
    #: Pushed trajectories that are followed at once: one that does not come back saves following the others.
    push_group: int = 4
    #: ⟨J⟩, in resolutions, below which a motion is next to synchrony: if it does not attract it is unstable, and no
    #: part of a slow set.
    next_to_synchrony: float = 10.0
    #: States that show a slow set; how far they are pushed, in resolutions, so that they leave the locked orbit on it;
    #: and how long they are left to fall back, in transients, too short to reach that orbit again.
    slow_states: int = 12
    slow_push: float = 5.0
    slow_time: float = 0.3

    # Whether chaos lasts.

    #: Trajectories of chaos that are followed, and the time for all of them together, in units of the lifetime beyond
    #: which it counts as lasting. If none of them leaves it, its lifetime is beyond that with 98 % certainty.
    followed: int = 32
    exposure: float = 4.0
    #: Where these leave open whether the lifetime is below or beyond, or where fewer than `fewest_ends` leave, so many
    #: times more are followed: stopping at few ends would favour samples in which, by chance, many left. Looking twice
    #: leaves 96 %.
    undecided: int = 10
    fewest_ends: int = 30
    #: Times, in those that another attractor takes to capture a trajectory, after which those who left at once and are
    #: not yet captured no longer make chaos seem to last.
    lateness: float = 2.0
    #: Largest radii from which they come, and how few that are left by then make the captures before count instead.
    far: float = 10.0
    fewest_left: int = 8
    #: Push, in resolutions, that parts trajectories which begin at different times of one and the same; and the share
    #: of the radius that it has at most. That of thin chaos rests on few pushes: of as large ones a third may leave.
    parting_push: float = 0.1
    parting_share: float = 0.01

    # When a label is certain.

    #: Successive returns within the radius after which a trajectory is captured: none passes by so often by chance.
    close_returns: int = 8
    #: Time by which a trajectory that comes near a set has come to a closed orbit in its midst, if it does at all; or
    #: this many times that of the last of a sample that does, if that is less.
    patient_time: float = 10_000.0
    patience_margin: float = 3.0
    #: Longest orbit, in returns, that a trajectory has to go round twice; it bounds the cost of a label.
    longest_orbit: int = 100

    # How much work is done.

    #: Time, in transients, of the first search, in which most trajectories have decided.
    quick: float = 0.3
    #: Unstable motions that a trajectory may come close to before it is given up; each costs a whole settling.
    trials: int = 2
    #: Trajectories that are followed without finding anything new before the others are left to what is known.
    fruitless: int = 3
    #: Trajectories that may be followed in vain at one a, over all rounds.
    in_vain: int = 6
    #: Rounds of labelling, each after something new was found, before the labels are left as they are.
    rounds: int = 20
    #: States, the first of each sample, whose labels are verified; the cost grows with them.
    verified: int = 60
    #: States ascribed to a chaotic attractor that are followed until they have settled.
    checked: int = 6

    # Pushes off what is unstable.

    #: Push, in resolutions, off an unstable motion on which a trajectory has settled.
    unstable_push: float = 0.1
    #: Push, in resolutions, off an unstable symmetry, of a state that is carried to the next a.
    symmetry_push: float = 0.1


#: Those of the package.
TUNING = Tuning()
