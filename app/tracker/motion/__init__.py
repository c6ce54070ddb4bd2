"""How an axis may move and what it does: limits, following error, correction."""
