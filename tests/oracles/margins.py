"""How far what was found is from what is allowed."""


def told(*values: object) -> None:
    """Printed: pytest shows it where a test fails, and of every test with -rP."""
    print(*values)
