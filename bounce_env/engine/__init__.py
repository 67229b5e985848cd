"""The exact bounce engine: knows numpy and numba, and nothing of Gymnasium."""
