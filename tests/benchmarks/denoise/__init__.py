"""Clean and feet, compared with filters and the published method."""
