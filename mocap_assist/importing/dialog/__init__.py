"""The dialog of Import, its settings for the chosen files, and the job that it starts."""
