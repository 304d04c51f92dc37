"""Makes the disk full for the ranks in FULL_RANKS, as far as they can tell: no file can be longer than FULL_BYTES."""

import os
import resource

if os.environ.get("OMPI_COMM_WORLD_RANK", "0") in os.environ["FULL_RANKS"].split(","):
    limit = int(os.environ["FULL_BYTES"])
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
