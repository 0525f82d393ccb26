"""Motions in a notebook and in a shell, and methods of a motion from later rooms."""
