"""The configuration of a study."""

from burridge_knopoff.config.message import ConfigError
from burridge_knopoff.config.study import Study, all_points, check_file, load_study, read_schema

__all__ = ["ConfigError", "Study", "all_points", "check_file", "load_study", "read_schema"]
