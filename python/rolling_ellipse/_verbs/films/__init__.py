"""The parts of `fit_motion`: a film and its unknowns, starts, search, errors, judgement."""
