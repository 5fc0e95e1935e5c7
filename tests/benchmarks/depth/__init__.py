"""Compare the depth tracker, its terms, detector and body with other trackers."""
