"""Read container formats and tables: C3D, Matroska, MATLAB, NumPy, JSON and text."""

from .c3d_file import BLOCK_BYTES, C3D_ID, CHARACTERS, FLOATS, INTEGERS, C3dFile, is_c3d
from .delimited import SPACE, find_separator, ignored_columns, split_cells, stream_cells
from .folder_scan import check_folder_access, files_below, is_folder
from .frame_files import (
    FrameFiles,
    NamesByNumber,
    describe_frame_files,
    frame_files,
    names_by_number,
)
from .glb_file import GlbFile, json_length, vector
from .growing_table import GrowingTable
from .json_members import (
    JsonMember,
    array_from_json,
    json_content,
    json_frame_files,
    json_members,
)
from .line_reader import Block, LineReader
from .listed_images import is_listed, max_color_size, open_bounded_image, open_listed_image
from .matlab_file import MatlabArray, is_matlab, matlab_arrays
from .matroska import Matroska, Track, index_matroska, is_matroska
from .names import MAX_NAME_LENGTH, UniqueNames, printable, shown
from .numbered_words import NUMBER, NumberedWords
from .png_header import PngHeader, is_png, read_png_header
from .row_stream import stream_rows
from .size_limits import check_n_joints, check_n_poses
from .stored_arrays import (
    NPY_MAGIC,
    NUMBERS,
    ZIP_MEMBER,
    archive_names,
    read_archive,
    read_archive_members,
    read_archive_words,
    read_array,
)
from .stored_bytes import (
    CHUNK_BYTES,
    MAX_CHECKED_BYTES,
    MAX_DEFLATE_RATIO,
    ByteSlice,
    PackedBytes,
    PlainBytes,
    StoredBytes,
)
from .text import (
    BYTE_ORDER_MARK,
    ROWS_AT_ONCE,
    as_utf8,
    decode_text,
    is_missing,
    parse_rows,
    read_bytes,
    read_number,
    read_rows,
    spaces_from_commas,
)

__all__ = [
    "BLOCK_BYTES",
    "BYTE_ORDER_MARK",
    "C3D_ID",
    "CHARACTERS",
    "CHUNK_BYTES",
    "FLOATS",
    "INTEGERS",
    "MAX_CHECKED_BYTES",
    "MAX_DEFLATE_RATIO",
    "MAX_NAME_LENGTH",
    "NPY_MAGIC",
    "NUMBER",
    "NUMBERS",
    "ROWS_AT_ONCE",
    "SPACE",
    "ZIP_MEMBER",
    "Block",
    "ByteSlice",
    "C3dFile",
    "FrameFiles",
    "GlbFile",
    "GrowingTable",
    "JsonMember",
    "LineReader",
    "MatlabArray",
    "Matroska",
    "NamesByNumber",
    "NumberedWords",
    "PackedBytes",
    "PlainBytes",
    "PngHeader",
    "StoredBytes",
    "Track",
    "UniqueNames",
    "archive_names",
    "array_from_json",
    "as_utf8",
    "check_folder_access",
    "check_n_joints",
    "check_n_poses",
    "decode_text",
    "describe_frame_files",
    "files_below",
    "find_separator",
    "frame_files",
    "ignored_columns",
    "index_matroska",
    "is_c3d",
    "is_folder",
    "is_listed",
    "is_matlab",
    "is_matroska",
    "is_missing",
    "is_png",
    "json_content",
    "json_frame_files",
    "json_length",
    "json_members",
    "matlab_arrays",
    "max_color_size",
    "names_by_number",
    "open_bounded_image",
    "open_listed_image",
    "parse_rows",
    "printable",
    "read_archive",
    "read_archive_members",
    "read_archive_words",
    "read_array",
    "read_bytes",
    "read_number",
    "read_png_header",
    "read_rows",
    "shown",
    "spaces_from_commas",
    "split_cells",
    "stream_cells",
    "stream_rows",
    "vector",
]
