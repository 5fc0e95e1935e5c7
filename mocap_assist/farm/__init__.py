"""Submit takes to a render farm: the button Submit Folder."""
