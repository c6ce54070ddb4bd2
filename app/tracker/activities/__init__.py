"""How each activity begins and what it does at every tick."""
