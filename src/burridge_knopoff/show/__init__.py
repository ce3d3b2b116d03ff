"""Descriptions and pictures of result files."""
