"""The simulated body: momentum, contact forces and slide."""
