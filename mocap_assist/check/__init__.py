"""The buttons Check, Compare and Revert."""
