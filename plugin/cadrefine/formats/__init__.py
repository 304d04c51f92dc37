"""Meshes in the formats of other programs than ParaView, read and written; loaded where such a file is named."""


class BadFile(Exception):
    """What is wrong with the file, or what is missing to read it."""
