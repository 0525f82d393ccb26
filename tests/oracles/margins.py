"""Numbers that a test prints beside its bounds."""


def told(*values: object) -> None:
    """Print numbers, which pytest shows if the test fails and, with -rP, for every test."""
    print(*values)
