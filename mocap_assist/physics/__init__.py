"""The button Physics."""
