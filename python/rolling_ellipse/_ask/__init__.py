"""What is asked: arguments, the scene with its blow, and how it is to be computed."""
