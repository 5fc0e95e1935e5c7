"""Rings on the floor while feet, hands, knees or hips are down."""
