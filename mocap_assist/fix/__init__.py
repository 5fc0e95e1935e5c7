"""The button Fix My Take, and the card that reports what it did."""
