"""The armature that Track made: its body, its action and the checks before a new track."""
