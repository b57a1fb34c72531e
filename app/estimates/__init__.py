"""How long things take: learned from what was seen, simulated for what is planned, scored against what came."""
