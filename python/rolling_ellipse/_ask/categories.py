"""Categories of the package's warnings."""


class ValidityWarning(UserWarning):
    """Warning: part of the motion is impossible for a body on the ground."""


class StabilityWarning(UserWarning):
    """Warning: the computed motion has lost energy or drifts off its constraints."""


class CompletenessWarning(UserWarning):
    """Warning: the results of a search are not proved to be complete."""


class ExtrapolationWarning(UserWarning):
    """Warning: a forecast is for a change large enough to alter the order of events."""
