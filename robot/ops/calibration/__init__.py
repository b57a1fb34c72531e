"""Measuring a robot: how far its wheels roll per count, how wide they stand, how its diodes and its camera see."""
