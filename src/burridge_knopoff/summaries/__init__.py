"""Summaries: from point files to one netCDF file a question, over (law, initial, a)."""
