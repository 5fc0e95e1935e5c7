"""Several people before one depth camera."""
