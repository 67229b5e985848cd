"""Part 2: stiff, extreme and degenerate cases, each with its right answer and a bound that was stated beforehand."""
