"""The classes of the objects in cached results of a continuation: a file in the cache can name no others."""

from __future__ import annotations

from burridge_knopoff.attractors.attractor import Attractor, Lifetime
from burridge_knopoff.attractors.capture_radius import Capture
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.laws import LAWS, FormulaLaw
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.own_units import OwnUnits
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import ReturnSection
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.periodic_orbits.branch_segment import HalfBranch
from burridge_knopoff.periodic_orbits.parameter_line import ParameterLine
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.section import Section

CLASSES = (
    *(Model, Chain, ChainState, Section, FormulaLaw, *LAWS.values()),
    *(Search, SearchSettings, Capture, Attractor, SteadyMotion, MotionSettings, MotionKind, Symmetry, Lifetime),
    ReturnSection,
    *(PeriodicOrbit, HalfBranch, BranchOrbit, ParameterLine, OwnUnits),
)
