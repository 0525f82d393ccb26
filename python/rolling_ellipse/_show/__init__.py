"""Motions in a notebook and in a shell, and methods of Trajectory that are imported late."""
