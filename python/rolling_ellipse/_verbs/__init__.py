"""Functions of scenes: simulation of one or many, proofs, classification, fits and races."""
