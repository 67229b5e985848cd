"""The lab: what the engine does, in a browser, to try out by hand."""
