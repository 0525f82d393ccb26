"""Motions: samples, events and states, files and tables."""
