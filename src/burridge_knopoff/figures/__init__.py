"""Figures: each module turns datasets into one matplotlib Figure."""
