"""Why chains synchronize: orbits and their multipliers, attractors, their basins, longer chains."""
