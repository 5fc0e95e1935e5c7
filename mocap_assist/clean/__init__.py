"""The buttons Clean, Learn and Plant Feet."""
