"""Code shared by all buttons: selection, solving, waiting and redoing."""
