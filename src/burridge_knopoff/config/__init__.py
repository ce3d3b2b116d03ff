"""The configuration of a study."""

from burridge_knopoff.config.message import ConfigError
from burridge_knopoff.config.study import Study, all_points, load_study
from burridge_knopoff.config.yaml_file import read_config, read_schema, read_yaml

__all__ = ["ConfigError", "Study", "all_points", "load_study", "read_config", "read_schema", "read_yaml"]
