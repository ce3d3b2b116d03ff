"""Summaries: one netCDF file per question, from point files or, where no single run suffices, from the model."""
