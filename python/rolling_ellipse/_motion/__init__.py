"""Motions: their samples, events and derivatives, and their export to files and tables."""
