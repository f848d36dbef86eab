"""Monte Carlo localization on a likelihood field: the usual way, tuned, to compare with."""
