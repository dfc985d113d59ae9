"""``python -m catenary_fe`` is ``catenary-fe``."""

from catenary_fe.cli.main import entry

if __name__ == "__main__":
    entry()
