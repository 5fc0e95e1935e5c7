"""Compare Retarget and Unbake with other retargeters."""
