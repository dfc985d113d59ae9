"""The assembled line, in numpy and scipy alone: mesh, elements, springs, system."""

from catenary_fe.fe.mesh import MeshSettings

__all__ = ["MeshSettings"]
