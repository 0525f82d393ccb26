"""Arguments of the public functions: numbers, scenes with their blows, and solver settings."""
