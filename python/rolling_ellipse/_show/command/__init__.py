"""Parts of the command line: its options, and the summary of a motion."""
