"""The attractors of one model: convergence, search, capture, labels."""
