"""Categories of the package's warnings."""


class ValidityWarning(UserWarning):
    """Part of the motion is impossible for a body on the ground."""


class StabilityWarning(UserWarning):
    """The computed motion has lost energy or drifted off its constraints."""


class CompletenessWarning(UserWarning):
    """The results of a search are not proved to be complete."""


class ExtrapolationWarning(UserWarning):
    """A forecast extrapolates to a change large enough to alter the sequence of events."""
