"""Evaluation on held-out episodes; `python -m agents.evaluate`."""
