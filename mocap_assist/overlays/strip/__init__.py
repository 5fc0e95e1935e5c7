"""The strip of ranges at the bottom of the Timeline, the Dope Sheet and the Graph Editor."""
