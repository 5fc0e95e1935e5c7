"""What processes of Mocap Assist share: threads, workers, locks and scratch folders.

Nothing here imports numpy: `threads` must act before that is imported.
"""
