"""What a chain comes to: attractors, how states are labelled by them, basins, longer chains."""
