"""The jobs of a study: what each reads and makes, what its files depend on, and how they are made."""
