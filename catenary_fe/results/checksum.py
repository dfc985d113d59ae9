"""A checksum of a dataset's content, the same before it is stored and after it is read again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

ATTRIBUTE = "content_sha256"  # where a stored dataset keeps it


def checksum(data: xr.Dataset) -> str:
    """SHA-256 of all values, names, dimensions and attributes, but for one that holds a checksum."""
    found = hashlib.sha256()
    for name in sorted(map(str, data.variables)):
        variable = data[name]
        found.update(repr((name, variable.dims, variable.shape)).encode())
        found.update(_attributes(variable.attrs))
        values = np.asarray(variable.values)
        if values.dtype.kind == "f":
            found.update(np.ascontiguousarray(values, dtype=f"<f{values.dtype.itemsize}").data)
        elif values.dtype.kind in "iu":  # netCDF's classic format has widths of its own
            found.update(np.ascontiguousarray(values, dtype="<i8").data)
        else:
            found.update(json.dumps([str(v) for v in values.ravel()]).encode())
    found.update(_attributes({k: v for k, v in data.attrs.items() if k != ATTRIBUTE}))
    return found.hexdigest()


def _attributes(attributes: Mapping[Any, Any]) -> bytes:
    texts = {str(k): v if isinstance(v, str) else repr(np.asarray(v).tolist()) for k, v in attributes.items()}
    return json.dumps(texts, sort_keys=True).encode()
