"""What a person calls from Python: models or words, plain numbers, and settings by name; all else takes typed ones."""
