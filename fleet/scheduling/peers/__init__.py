"""Public solvers behind Mend's own interface, to compare with: none of them knows transfers.

They minimize distance and the number of robots; the rest of the objective is only recomputed.
Two of them come with the extra `peers`.
"""
