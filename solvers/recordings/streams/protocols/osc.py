"""Read and write packets of Open Sound Control 1.0 [1]_: messages, and bundles of them.

References
----------
.. [1] Wright (2002). The Open Sound Control 1.0 specification. opensoundcontrol.stanford.edu
"""

import itertools
import struct
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ....errors import InvalidMotionError

Argument = int | float | str | bytes | bool | None

BUNDLE = b"#bundle\0"
IMMEDIATELY = b"\0\0\0\0\0\0\0\1"
"""The time tag of a bundle whose messages are due at once."""
MAX_DEPTH = 4
"""Maximum nesting of bundles; senders of motion do not nest them. It bounds recursion."""
MAX_MESSAGES = 512
"""Maximum number of messages in a packet; a body has 55 bones. It bounds the time of a
packet."""
WORD_BYTES = 4
"""Bytes to whose multiples everything is padded."""
NUMBERS = {"i": ">i", "f": ">f", "h": ">q", "d": ">d", "t": ">Q"}
WITHOUT_DATA: dict[str, Argument] = {"T": True, "F": False, "N": None, "I": float("inf")}
DAMAGED = "A packet of Open Sound Control is damaged."


class Message(NamedTuple):
    """An address, and its arguments."""

    address: str
    arguments: tuple[Argument, ...]


def read_packet(packet: bytes) -> list[Message]:
    """Return the messages of a packet, those of bundles too, in their order.

    Raises
    ------
    InvalidMotionError
        The packet is damaged, or has more than 512 messages.
    """
    try:
        messages = list(itertools.islice(_messages(packet, MAX_DEPTH), MAX_MESSAGES + 1))
    except (struct.error, ValueError):
        raise InvalidMotionError(DAMAGED) from None
    if len(messages) > MAX_MESSAGES:
        raise InvalidMotionError(f"A packet has more than {MAX_MESSAGES} messages.")
    return messages


def write_message(address: str, *arguments: int | float | str) -> bytes:
    """Return a message; its arguments are of the types i, f and s."""
    tags, data = ",", b""
    for each in arguments:
        if isinstance(each, str):
            tags, data = f"{tags}s", data + _padded(each)
        elif isinstance(each, int):
            tags, data = f"{tags}i", data + struct.pack(">i", each)
        else:
            tags, data = f"{tags}f", data + struct.pack(">f", each)
    return _padded(address) + _padded(tags) + data


def write_bundle(messages: Sequence[bytes]) -> bytes:
    """Return a bundle of messages that are due at once."""
    sized = [struct.pack(">i", len(message)) + message for message in messages]
    return BUNDLE + IMMEDIATELY + b"".join(sized)


def _messages(packet: bytes, depth: int) -> Iterator[Message]:
    if not packet.startswith(BUNDLE):
        yield _message(packet)
        return
    if not depth:
        raise ValueError("nested too deeply")
    offset = len(BUNDLE) + len(IMMEDIATELY)
    while offset < len(packet):
        (size,) = struct.unpack_from(">i", packet, offset)
        offset += WORD_BYTES
        if not 0 < size <= len(packet) - offset or size % WORD_BYTES:
            raise ValueError("size")
        yield from _messages(packet[offset : offset + size], depth - 1)
        offset += size


def _message(packet: bytes) -> Message:
    address, offset = _text(packet, 0)
    if not address.startswith("/"):
        raise ValueError("address")
    tags, offset = _text(packet, offset)
    if not tags.startswith(","):
        raise ValueError("types")
    arguments: list[Argument] = []
    for tag in tags[1:]:
        argument, offset = _argument(packet, offset, tag)
        arguments.append(argument)
    return Message(address, tuple(arguments))


def _argument(packet: bytes, offset: int, tag: str) -> tuple[Argument, int]:
    """Return an argument, and where the next one begins."""
    if tag in NUMBERS:
        (number,) = struct.unpack_from(NUMBERS[tag], packet, offset)
        return number, offset + struct.calcsize(NUMBERS[tag])
    if tag in {"s", "S"}:
        return _text(packet, offset)
    if tag == "b":
        (size,) = struct.unpack_from(">i", packet, offset)
        end = offset + WORD_BYTES + size
        if size < 0 or end > len(packet):
            raise ValueError("blob")
        return packet[offset + WORD_BYTES : end], _aligned(end)
    if tag in WITHOUT_DATA:
        return WITHOUT_DATA[tag], offset
    raise ValueError("type")


def _text(packet: bytes, offset: int) -> tuple[str, int]:
    end = packet.index(b"\0", offset)
    return packet[offset:end].decode("utf-8"), _aligned(end + 1)


def _aligned(offset: int) -> int:
    return -(-offset // WORD_BYTES) * WORD_BYTES


def _padded(text: str) -> bytes:
    content = text.encode() + b"\0"
    return content + b"\0" * (_aligned(len(content)) - len(content))
