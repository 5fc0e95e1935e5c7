"""Live streams: recorded on a rig, or used to search the library by performing."""
