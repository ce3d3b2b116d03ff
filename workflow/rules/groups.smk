# Groups of jobs on a cluster, if the profile names them among `group-components`.


def group(name):
    """Return the name of a group of jobs if the profile names it among `group-components`, otherwise None."""
    return lambda wildcards: name if name in group_sizes(workflow) else None


def fixed_group(name, points):
    """Return a function that assigns the jobs of a rule to groups; to none unless `group-components` has a size.

    Snakemake would form groups at random. These groups are always the same, so that a run finds those of an earlier run
    that was killed.
    """
    numbers = {frozenset(point.items()): number for number, point in enumerate(points)}

    def group_of(wildcards):
        # Known only when jobs are planned.
        size = group_sizes(workflow).get(name, 1)
        number = numbers.get(frozenset(wildcards.items()))
        if size == 1 or number is None:
            return None
        group = f"{name}{number // size}"
        join_groups(workflow, group, name)
        return group

    return group_of
