"""Compare Find Similar and gestures with published methods."""
