"""Figures: each module takes datasets and returns one matplotlib Figure."""
