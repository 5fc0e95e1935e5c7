"""Takes of video models: made with their typical faults, and real ones."""
