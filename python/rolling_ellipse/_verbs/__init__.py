"""What can be done with a scene: simulate it, many of them, prove, classify, race."""
