# What rules of several stages use.


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
    # Snakemake unites jobs that need nothing of each other up to the size of the parent group.
    workflow.parent_groupids[group] = name
    return group


def basin_config(*unused):
    """Return what maps depend on, without some keys of the section of basins."""
    # Neither the list of maps nor the number of threads changes a map.
    unused = {*LAWS, "threads", *unused}
    section = STUDY.config["basins"]
    return {
        **{key: STUDY.config[key] for key in (*ATTRACTOR_KEYS, "initial")},
        "basins": {key: section[key] for key in section if key not in unused},
    }
