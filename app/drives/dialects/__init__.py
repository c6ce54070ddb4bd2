"""How drives of one kind are commanded through their registers."""
