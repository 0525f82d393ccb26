"""The parts of the command line: what can be typed, what is said of a motion, the page."""
