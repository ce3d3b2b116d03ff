"""netCDF files: the only place that names their variables, attributes and encodings."""
