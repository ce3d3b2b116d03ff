"""Basins of attraction: maps, fractions, boundaries and their edge states."""
