"""Descriptions and pictures of files of results."""
