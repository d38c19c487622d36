"""The parts of the hero's build; `hero.py` in the folder above puts them together."""
