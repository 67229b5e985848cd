"""What a person does with a game in a window."""
