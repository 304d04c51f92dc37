"""The driver: see cadrefine.py."""
