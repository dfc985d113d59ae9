"""The paper's scripts import what they share from beside them."""

import sys
from pathlib import Path

SCRIPTS = Path(__file__).parents[2] / "models" / "paper"
sys.path.insert(0, str(SCRIPTS))
