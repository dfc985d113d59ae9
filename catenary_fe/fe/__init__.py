"""The finite-element model in Exudyn. The only room that imports exudyn, and only where it is built."""

from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.fe.solver_settings import TimeSettings

__all__ = ["MeshSettings", "TimeSettings"]
