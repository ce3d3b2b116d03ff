"""What is wrong with the files of a study, and which of them belong to no point of it."""
