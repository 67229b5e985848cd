"""Replays: what happened in a world, exactly, in one HTML page that stands alone. docs/replay.md has the format."""
