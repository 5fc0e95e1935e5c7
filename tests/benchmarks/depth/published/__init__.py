"""Figures of [WZC12] and [LOU12], measured with their methods as published."""
