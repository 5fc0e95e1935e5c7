"""The button Find Similar, and what can be done with matches."""
