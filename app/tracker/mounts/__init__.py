"""How a panel hangs on its axes: which directions of the sky the axis angles of each mount mean."""
