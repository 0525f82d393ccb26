"""The data in a page of the player."""

import base64
import gzip
import json
import re
from typing import Any, NoReturn


def carried(html: str) -> dict[str, Any]:
    """The data of the first player in a fragment or a page, read as JSON without NaN."""

    def refused(name: str) -> NoReturn:
        raise ValueError(name)

    found = re.search(r'unzipped\("([A-Za-z0-9+/=]+)"\)', html)
    assert found is not None
    text = gzip.decompress(base64.b64decode(found[1])).decode("utf-8")
    data: dict[str, Any] = json.loads(text, parse_constant=refused)
    return data
