# Groups of jobs, for a cluster: those that the profile names among `group-components`.


def group(name):
    """Return the name of a group of jobs if the profile has it among `group-components`, else None."""
    return lambda wildcards: (
        name if name in workflow.group_settings.group_components else None
    )


def fixed_group(name, points):
    """Return what gives the jobs of a rule their groups, by wildcards; none unless `group-components` has a size.

    Snakemake would put jobs together at random. These groups are always the same, so that a run finds those of an
    earlier one that was killed.
    """
    numbers = {frozenset(point.items()): number for number, point in enumerate(points)}

    def group_of(wildcards):
        # Known only when jobs are planned.
        size = workflow.group_settings.group_components.get(name, 1)
        number = numbers.get(frozenset(wildcards.items()))
        if size == 1 or number is None:
            return None
        group = f"{name}{number // size}"
        # Snakemake unites jobs that need nothing of each other up to the size of the parent group. Nothing documented
        # says which jobs: a group named by wildcards cannot cut the grid into pieces. tests/workflow/test_groups.py
        # holds it.
        workflow.parent_groupids[group] = name
        return group

    return group_of
