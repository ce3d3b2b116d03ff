"""Basins of attraction: maps, fractions, uncertainty of their boundaries."""
