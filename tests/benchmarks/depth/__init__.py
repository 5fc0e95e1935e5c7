"""The depth tracker, its terms, detector and body, beside other trackers."""
