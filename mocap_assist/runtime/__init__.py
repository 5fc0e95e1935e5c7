"""What all buttons have in common: what is selected, solving, waiting and redoing."""
