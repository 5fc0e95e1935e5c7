"""The button Vary: many actions made from a few, listed, picked, and assigned to a crowd."""
