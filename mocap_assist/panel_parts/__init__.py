"""Parts that the panels of several features share: layout, presets, cards, visibility."""
