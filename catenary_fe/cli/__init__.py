"""The command line: reads arguments, calls the rooms below, prints."""

from catenary_fe.cli.main import main

__all__ = ["main"]
