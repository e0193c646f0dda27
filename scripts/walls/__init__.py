"""The walls that scripts/check holds; layers.py says where they stand."""
