"""Retarget and Unbake, beside other retargeters."""
