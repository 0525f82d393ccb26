"""What a motion looks like in a notebook and in a shell, and the methods bound from above."""
