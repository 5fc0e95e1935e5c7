"""File formats of Export, for Blender and for the process without it."""

from ...solvers.settings import Choice


class FileFormat(Choice):
    """File to write."""

    FBX = "fbx", "Write for Unreal, Unity, Maya and MotionBuilder; centimeters, Y up", "FBX"
    GLB = "glb", "Write for glTF viewers, the web and game engines; meters, Y up", "GLB"
    BVH = "bvh", "Write only the body, for any motion tool; centimeters, Y up", "BVH"

    @property
    def ending(self) -> str:
        """End of the name of the file."""
        return f".{self.value}"

    @property
    def unit_name(self) -> str:
        """Unit of the file, for the report."""
        return "meters" if self is FileFormat.GLB else "centimeters"


class ExportedBones(Choice):
    """Bones to export."""

    ALL = "all", "Export all bones; for Rigify rigs, only the deform bones", "All Bones"
    DEFORM = (
        "deform",
        "Export only bones that deform a mesh, for other control rigs",
        "Deform Bones",
    )
