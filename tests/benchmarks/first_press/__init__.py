"""Clean at the first press, without examples, next to the filters an animator has."""
