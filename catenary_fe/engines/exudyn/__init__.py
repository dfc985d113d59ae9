"""The line as an Exudyn multibody system: the only room that imports exudyn."""
