"""Find Similar and gestures, beside published methods."""
