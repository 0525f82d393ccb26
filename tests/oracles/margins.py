"""Figures that a test prints beside its bounds."""


def told(*values: object) -> None:
    """Print figures: pytest shows them for a test that fails, and for every test with -rP."""
    print(*values)
