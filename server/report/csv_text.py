"""Texts in a table that a spreadsheet may open."""

FORMULA_SIGNS = ("=", "+", "-", "@", "\t", "\r")
"""What a spreadsheet takes for the beginning of a formula (OWASP, CSV Injection)."""


def no_formula(text: str) -> str:
    """A text that no spreadsheet takes for a formula, whatever people and robots are called."""
    return f"'{text}" if text.startswith(FORMULA_SIGNS) else text
