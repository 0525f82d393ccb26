"""Helpers shared by several tests: references for the package, scenes, tables, paths."""
