"""Share a batch among machines: records, claims, shards, manifests and hooks."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .claims import RENEWAL_INTERVAL_S, claimed
    from .fingerprints import fingerprint, is_of_another_build, stamp_options
    from .hooks import hook_remark, parse_hook, run_hook
    from .manifest import Listed, read_manifest
    from .records import Record, Records
    from .shards import Shard, parse_shard

__all__ = [
    "RENEWAL_INTERVAL_S",
    "Listed",
    "Record",
    "Records",
    "Shard",
    "claimed",
    "fingerprint",
    "hook_remark",
    "is_of_another_build",
    "parse_hook",
    "parse_shard",
    "read_manifest",
    "run_hook",
    "stamp_options",
]

import_on_demand(__name__)
