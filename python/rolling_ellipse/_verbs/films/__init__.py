"""The parts of `fit_motion`: film and unknowns, starting points, search, errors and verdict."""
