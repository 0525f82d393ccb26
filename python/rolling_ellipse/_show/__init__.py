"""Motions in a shell, and methods of Trajectory that are imported late."""
