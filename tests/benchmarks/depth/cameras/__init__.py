"""Several depth cameras: made sequences and what the second camera gains."""
