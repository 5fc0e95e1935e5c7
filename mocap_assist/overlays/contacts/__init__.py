"""Rings on the floor under feet, hands, knees and hips in contact."""
