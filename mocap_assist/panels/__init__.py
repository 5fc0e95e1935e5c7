"""Drawing code that several panels share."""
