"""Production rigs: controls, what they move, and Rigify."""
