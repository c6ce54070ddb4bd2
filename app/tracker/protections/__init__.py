"""What wind, snow and light demand of a tracker: pure state machines and what an engineer sets for them."""
