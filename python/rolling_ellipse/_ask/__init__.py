"""Arguments: numbers, the scene with its blow, and the settings of a computation."""
