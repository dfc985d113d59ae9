"""Eigenforms of the line about its static state, and runs on a line that answers with its lowest ones."""
