"""Many actions of a few: made by Vary, listed, picked from, and given to a crowd."""
