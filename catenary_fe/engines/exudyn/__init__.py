"""The assembled line as an Exudyn model, for scripts and for runs by Exudyn's solver."""

from catenary_fe.engines.exudyn.build import ExudynModel, exudyn_model
from catenary_fe.engines.exudyn.contact import ContactParts, PantographParts, WireParts

__all__ = ["ContactParts", "ExudynModel", "PantographParts", "WireParts", "exudyn_model"]
