"""What is wrong with the files of a study, and which of them are not part of it."""
