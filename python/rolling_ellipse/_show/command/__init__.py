"""Parts of the command line: options, summary of a motion, page of `explore`."""
