"""Keeping what must be kept, for as long as it may be: records, backups, a person's data, retention."""
