"""Linearised runs in compiled code: small motions about the static state, with contact and slack droppers."""
