"""Clean and feet, beside filters and the published method."""
