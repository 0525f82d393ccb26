"""The categories of the warnings that the package issues."""


class ValidityWarning(UserWarning):
    """Part of the motion is not what a body on the ground would do."""


class StabilityWarning(UserWarning):
    """What was asked for is known to lose what the motion keeps: constraints, energy or both."""


class CompletenessWarning(UserWarning):
    """What was asked for was found by looking closely, and not proved to be all there is."""
