"""`python -m solvers VERB ...`: the project without Blender.

Its options also serve `blender --command mocap_assist`.
"""
