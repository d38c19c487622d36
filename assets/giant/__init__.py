"""The parts of the script that builds the colossus; see `../colossus.py`."""
