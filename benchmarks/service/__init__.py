"""Load that the service carries, measured from outside: `make bench-service`."""
