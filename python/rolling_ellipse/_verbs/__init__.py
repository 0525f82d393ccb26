"""Functions that take scenes: simulation of one or many, proofs, classification, races."""
