"""What moves the assembled line in time, or finds its modes: engines that do not know each other."""
