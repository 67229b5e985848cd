"""The report: error against run time, stability, and what features cost, made from nothing by one command."""
