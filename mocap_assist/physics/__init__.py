"""The button Simulate."""
