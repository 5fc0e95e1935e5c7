"""The buttons Retarget and Unbake."""
