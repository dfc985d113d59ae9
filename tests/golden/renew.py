"""Compute the golden set anew and say what moved: ``python tests/golden/renew.py``.

To be run when a change is meant to move numbers; what it prints belongs into the changelog, under "Numbers
that moved".
"""

import json

from results import FILE, compute


def main() -> None:
    """Write the file; print what is not as it was."""
    before = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    now = compute()
    for case, numbers in now.items():
        for name, value in numbers.items():
            old = before.get(case, {}).get(name)
            if old is None:
                print(f"{case}: {name}: new, {value:.6g}")
            elif value != old:
                print(f"{case}: {name}: {old:.9g} -> {value:.9g} ({value - old:+.2g})")
    for case, numbers in before.items():
        for name in numbers:
            if name not in now.get(case, {}):
                print(f"{case}: {name}: gone")
    FILE.write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
    print(f"written: {FILE.name}")


if __name__ == "__main__":
    main()
