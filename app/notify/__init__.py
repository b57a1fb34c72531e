"""Telling people: a notice is written with the change itself, shown in the inbox and mailed by a worker.

Each person is told each thing of an order once, whatever is repeated or crashes (the tables' unique keys see to it).
"""
