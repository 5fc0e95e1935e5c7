"""How much each tuned constant of the solvers moves the errors on development clips."""
