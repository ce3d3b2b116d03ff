# What rules of several stages use.
from burridge_knopoff.study.model import MODEL_KEYS


def script_sources(name):
    """Return the fingerprint of a script and of all that it imports: what a rule does, comments left out."""
    return source_fingerprint(Path(workflow.basedir, f"workflow/scripts/{name}.py"))


def fixed_group(name, number):
    """Return the group of a job, given its number among those of its rule; None unless `group-components` has a size.

    Snakemake would put jobs together at random. These groups are always the same, so that a run finds those of an
    earlier one that was killed.
    """
    size = workflow.group_settings.group_components.get(name, 1)
    if size == 1 or number is None:
        return None
    group = f"{name}{number // size}"
    # Snakemake unites jobs that need nothing of each other up to the size of the parent group. Nothing documented says
    # which jobs: a group named by wildcards cannot cut the grid into pieces. tests/workflow/test_groups.py holds it.
    workflow.parent_groupids[group] = name
    return group


def model_config(laws=STUDY.laws):
    """Return what decides the models of a study under some of its laws; see `config.model.model_of`."""
    config = {key: STUDY.config[key] for key in MODEL_KEYS}
    return {**config, "laws": {law: config["laws"][law] for law in laws}}


def motion_config():
    """Return how kinds of motion are told."""
    key = "synchronization_threshold"
    return {**STUDY.config["motion"], key: STUDY.config[key]}


# Springs and thresholds given one by one are those of one chain: there is no such chain of another length.
SINGLE_LENGTH = [
    key for key, value in STUDY.config["chain"].items() if isinstance(value, list)
]


def other_length_config(laws=STUDY.laws):
    """Return the same for chains of other lengths; raises ConfigError if the study has one length only."""
    if SINGLE_LENGTH:
        key = SINGLE_LENGTH[0]
        raise ConfigError(
            f"chain.{key}: {STUDY.config['chain'][key]} is not allowed for chains of another length: one number"
        )
    return model_config(laws)


def basin_config(*unused):
    """Return the section of basins without what has a name of its own, or changes no map, and without unused keys."""
    unused = {"a", "initial", "threads", *unused}
    section = STUDY.config["basins"]
    return {key: section[key] for key in section if key not in unused}
