"""Preferences of live streams: who may send to this machine."""

import bpy

from ...solvers.errors import InvalidSettingError
from ...solvers.recordings.streams import PORT
from ..panel_parts.preference_values import preference_value, preferences

OFFLINE = (
    "Blender's online access is off. Allow it in Preferences > System to receive from other"
    " machines."
)
NO_ADDRESSES = (
    "Other machines may send, but no address is allowed. Add those of your trackers in the"
    " preferences, or switch it off."
)


def live_port() -> int:
    """Return the UDP port of live streams."""
    return int(preference_value("live_port")) if preferences() is not None else PORT


def allowed_addresses() -> str:
    """Return the addresses of other machines that may send; empty: none.

    Raises
    ------
    InvalidSettingError
        Other machines may send, but no address is listed, or Blender is offline.
    """
    if preferences() is None or not preference_value("live_network"):
        return ""
    addresses = str(preference_value("live_addresses"))
    if not addresses.strip(" ,"):
        raise InvalidSettingError(NO_ADDRESSES)
    if not bpy.app.online_access:
        raise InvalidSettingError(OFFLINE)
    return addresses
