"""Motions in a shell."""
