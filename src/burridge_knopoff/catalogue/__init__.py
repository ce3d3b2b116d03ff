"""Catalogues of slip events and their statistics."""
