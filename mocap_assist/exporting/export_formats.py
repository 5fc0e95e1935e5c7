"""File formats of Export, for Blender and for the process without it."""

from ...solvers.settings import Choice


class FileFormat(Choice):
    """File to write."""

    FBX = "fbx", "For Unreal, Unity, Maya and MotionBuilder; centimeters, Y up", "FBX"
    GLB = "glb", "For glTF viewers, the web and game engines; meters, Y up", "GLB"
    BVH = "bvh", "The body alone, for every motion tool; centimeters, Y up", "BVH"

    @property
    def ending(self) -> str:
        """End of the name of the file."""
        return f".{self.value}"

    @property
    def unit_name(self) -> str:
        """Unit of the file, for the report."""
        return "meters" if self is FileFormat.GLB else "centimeters"


class ExportedBones(Choice):
    """Bones that come into the file."""

    ALL = "all", "All bones; of a rig by Rigify only those that deform", "All Bones"
    DEFORM = "deform", "Only bones that deform a mesh, for other control rigs", "Deform Bones"
