"""What leaves the package for others to read: files and tables."""
