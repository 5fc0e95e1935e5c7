"""The button Reconstruct."""
