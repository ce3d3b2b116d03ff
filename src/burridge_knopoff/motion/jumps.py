"""Jumps of the equations of motion at events: of U'' where a block stops, and of U''' where it starts.

A block stops while friction still decelerates it: U'' jumps to 0. It starts when the force reaches its threshold: U''
is continuous, but grows at once, at the rate at which the force does.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import Model

ROUNDING = 1e-9


def event_jumps(
    model: Model, position: np.ndarray, velocity: np.ndarray, block: np.ndarray, is_stop: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return |ΔU''| of the block that stops, and |ΔU'''| of the block that starts, at successive events of a motion.

    position, velocity : x = U − vτ and U' of all blocks at the events, shape (n, blocks)
    block : the block of each event, from 1, shape (n,); is_stop : whether it stops, otherwise it starts
    The first event is left out if it is a stop, since the direction of the slip before it is not known. So is a block
    that slips backward at once, under symmetric contact.
    """
    chain = model.chain
    event, index = np.arange(len(block)), block - 1
    force = chain.force(position) + chain.damping_force(velocity, model.v)
    friction = chain.thresholds * model.friction(np.abs(velocity))
    acceleration = np.where(velocity == 0.0, 0.0, (force - np.sign(velocity) * friction) / chain.masses)
    growth = (chain.force(velocity - model.v) + chain.damping_force(acceleration, 0.0)) / chain.masses
    # A block slips in one direction from its start, where the force has this direction, to its stop.
    towards = np.sign(np.where(velocity != 0.0, velocity, force))
    # Rounding aside, the force is at its threshold where a block starts, and below it where a block sticks.
    turns = np.abs(force[event, index]) > (1.0 + ROUNDING) * chain.thresholds[index]
    turns &= model.contact == "symmetric"
    stops, starts = event[is_stop & ~turns & (event > 0)], event[~is_stop & ~turns]
    direction = towards[stops - 1, index[stops]]
    threshold, mass = chain.thresholds[index[stops]], chain.masses[index[stops]]
    return np.abs(force[stops, index[stops]] - direction * threshold) / mass, np.abs(growth[starts, index[starts]])
