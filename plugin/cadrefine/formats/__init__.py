"""Meshes in the formats of other programs than ParaView, read and written; loaded where such a file is named."""

import importlib


class BadFile(Exception):
    """What is wrong with the file, or what is missing to read it."""


def library(name):
    """A Python package that few need. Throws BadFile where it is not there."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = (error.name or name).partition(".")[0]
        raise BadFile(f"the Python package {package} is needed for this format (Debian: python3-{package})") from None
