"""Decompress frames of LZ4 [1]_, which Rokoko Studio sends.

References
----------
.. [1] Collet, LZ4 frame format 1.6 and LZ4 block format.
"""

from ....errors import InvalidMotionError

MAGIC = b"\x04\x22\x4d\x18"
MAX_OUTPUT_BYTES = 1 << 18
"""Maximum decompressed size; a frame of five actors with fingers takes 100 kB. It bounds memory
and time."""
MIN_MATCH = 4
LONG_LENGTH = 15
"""A length that continues in the next bytes; each 255 adds another byte."""
FULL_BYTE = 255
HAS_BLOCK_CHECKSUM, HAS_SIZE, HAS_CONTENT_CHECKSUM, HAS_DICTIONARY = 0x10, 0x08, 0x04, 0x01
IS_RAW = 0x8000_0000
DAMAGED = "A packet that is compressed with LZ4 is damaged."


def decompress(frame: bytes) -> bytes:
    """Return the content of a frame.

    Checksums are not compared: what comes out is parsed as JSON.

    Raises
    ------
    InvalidMotionError
        The frame is damaged, or its content larger than 256 kB.
    """
    try:
        return _decompress(frame)
    except IndexError:
        raise InvalidMotionError(DAMAGED) from None


def _decompress(frame: bytes) -> bytes:
    flags = frame[len(MAGIC)]
    offset = len(MAGIC) + 3
    offset += 8 * bool(flags & HAS_SIZE) + 4 * bool(flags & HAS_DICTIONARY)
    output = bytearray()
    while True:
        size = _size(frame, offset)
        offset += 4
        if not size:
            return bytes(output)
        length = size & ~IS_RAW
        block = frame[offset : offset + length]
        if len(block) < length:
            raise InvalidMotionError(DAMAGED)
        offset += length + 4 * bool(flags & HAS_BLOCK_CHECKSUM)
        if size & IS_RAW:
            output += block
        else:
            _append_block(output, block)
        _check_size(output)


def _append_block(output: bytearray, block: bytes) -> None:
    """Append the content of a block, whose matches may reach into blocks before."""
    offset = 0
    while offset < len(block):
        token = block[offset]
        count, offset = _length(block, offset + 1, token >> 4)
        if offset + count > len(block):
            raise IndexError
        output += block[offset : offset + count]
        offset += count
        _check_size(output)
        if offset == len(block):
            return
        distance = block[offset] | block[offset + 1] << 8
        count, offset = _length(block, offset + 2, token & LONG_LENGTH)
        _append_match(output, distance, count + MIN_MATCH)


def _append_match(output: bytearray, distance: int, count: int) -> None:
    """Append what stands at a distance before the end; it may overlap with itself."""
    if not 0 < distance <= len(output) or count > MAX_OUTPUT_BYTES:
        raise IndexError
    start = len(output) - distance
    match = bytes(output[start : start + count])
    repeats = -(-count // len(match))
    output += (match * repeats)[:count]
    _check_size(output)


def _length(block: bytes, offset: int, first: int) -> tuple[int, int]:
    """Return a length whose first four bits are known, and where it ends."""
    length = first
    if first == LONG_LENGTH:
        while True:
            more = block[offset]
            offset += 1
            length += more
            if more < FULL_BYTE:
                break
    return length, offset


def _size(frame: bytes, offset: int) -> int:
    if offset + 4 > len(frame):
        raise IndexError
    return int.from_bytes(frame[offset : offset + 4], "little")


def _check_size(output: bytearray) -> None:
    if len(output) > MAX_OUTPUT_BYTES:
        raise InvalidMotionError("A compressed packet is too large.")
