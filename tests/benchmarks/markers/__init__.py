"""Gaps, swaps and rigid clusters of markers, and the skeleton solved from them."""
