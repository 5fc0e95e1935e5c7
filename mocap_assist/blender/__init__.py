"""What Blender itself asks for: versions, names, paths, properties, long work in turns."""
