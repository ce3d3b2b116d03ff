"""The jobs of a study: what each reads and makes, what decides its files, and how it is done."""
