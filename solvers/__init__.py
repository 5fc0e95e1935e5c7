"""Everything that runs without Blender: arrays and files in, arrays and files out."""
