"""Query by performing: an actor before a camera gives commands and shows what to search for."""
