"""What watches a tracker at each tick and ends what must not go on."""
