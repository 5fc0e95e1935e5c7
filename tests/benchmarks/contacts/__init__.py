"""Contacts of feet and hands with the floor, in Clean, Reconstruct and Retarget."""
