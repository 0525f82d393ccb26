"""Helpers of several tests: references for the package, scenes, tables, paths."""
