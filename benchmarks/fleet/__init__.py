"""The fleet measured: traffic, dispatch, charging and estimates, in worlds that are simulated."""
