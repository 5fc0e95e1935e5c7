"""Compare Vary with other methods to make variants."""
