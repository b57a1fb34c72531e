"""What happens, told as it happens: one feed inside the service, one event stream per browser."""
