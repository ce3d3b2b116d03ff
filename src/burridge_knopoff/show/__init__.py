"""What is in a file of results: in a page of words, and as a picture."""
