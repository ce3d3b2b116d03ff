# Groups: on a cluster many short jobs are submitted as one; other runs know no groups.


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
