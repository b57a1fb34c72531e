"""The demonstration of a fleet: four robots with simulated bodies in the Carleton tunnels, and a stream of orders."""
