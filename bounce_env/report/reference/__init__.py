"""Independent solvers of 30 digits or more, which share no code and no method with the engine."""
