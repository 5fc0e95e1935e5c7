"""Failures an animator can act on. Every message is a full sentence for the status bar."""


class MocapAssistError(Exception):
    """Base class; operators and commands report its message and nothing else."""


class InvalidMotionError(MocapAssistError, ValueError):
    """The captured data cannot be used as given."""


class InvalidSettingError(MocapAssistError, ValueError):
    """A setting is outside the range in which the method is defined."""


class InvalidFileError(MocapAssistError, ValueError):
    """A file is not what its reader expects, or is damaged."""


class FileAccessError(InvalidFileError):
    """A file or folder cannot be opened now; its content is unknown."""


class SolveCancelled(MocapAssistError):
    """The animator pressed Escape."""


class OutOfMemoryError(MocapAssistError):
    """A solve needs more memory than available."""

    def __init__(
        self,
        sentence: str = "This needs more memory than is available. Work on a part of the take.",
    ) -> None:
        super().__init__(sentence)
