"""Summaries: one netCDF file for each question, from point files, or from the model where no single run answers it."""
