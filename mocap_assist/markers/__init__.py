"""The button Make Skeleton: from markers to the motion of a skeleton."""
