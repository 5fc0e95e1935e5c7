"""From depth pictures to motion: body model, tracker, detector, and both together."""
