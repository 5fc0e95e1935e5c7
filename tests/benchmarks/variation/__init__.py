"""Vary, beside other ways to make variants."""
