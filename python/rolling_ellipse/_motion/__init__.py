"""What comes back: a motion, its events and states, and the files and tables it becomes."""
