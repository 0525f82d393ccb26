"""The words of the explorer: one table for each language, in JSON files beside this one."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from .._ask.check import choice, shown

LANGUAGES = ("en", "de")
_BRACES = re.compile(r"\{(\w+)\}")


@cache
def packaged(name: str) -> str:
    """Return the text of a file beside this one."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


@cache
def _table(language: str) -> dict[str, str]:
    found: dict[str, str] = json.loads(packaged(f"words_{language}.json"))
    return found


def words(language: str | Mapping[str, str]) -> dict[str, str]:
    """Return the table of a language, or a copy of a mapping with the keys of the English one.

    A text must not ask for a number in braces that the English one does not have.
    """
    if isinstance(language, str):
        return dict(_table(choice("language", language, LANGUAGES)))
    if not isinstance(language, Mapping):
        raise TypeError(f"language must be a name or a mapping of texts, got {shown(language)}")
    english, found = _table("en"), dict(language)
    if odd := [*(key for key in english if key not in found), *(found.keys() - english.keys())]:
        raise ValueError(
            f"language must have the keys of explore(scene).words, got {len(found)} keys, and "
            f"{shown(odd[0])} is {'missing' if odd[0] in english else 'unknown'}"
        )
    for key, text in found.items():
        if not isinstance(text, str):
            raise TypeError(f"language[{key!r}] must be a string, got {shown(text)}")
        known = _BRACES.findall(english[key])
        if not set(_BRACES.findall(text)) <= set(known):
            raise ValueError(
                f"language[{key!r}] must have no braces but {known}, got {shown(text)}"
            )
    return found


def written(value: float, words: dict[str, str]) -> str:
    """Return a number with four digits as the language writes it."""
    text = f"{value:.4g}".replace("inf", "∞").replace("-", "−")
    return text.replace(".", words["decimal"])


def numbers_in(key: str) -> list[str]:
    """Return the names in braces of an English text."""
    return _BRACES.findall(_table("en")[key])


def filled(words: dict[str, str], key: str, **values: float) -> str:
    """Return a text with numbers in its braces."""
    return _BRACES.sub(lambda found: written(values[found[1]], words), words[key])


def escaped(words: dict[str, str]) -> dict[str, str]:
    """Return the texts for HTML."""
    return {key: html.escape(text) for key, text in words.items()}
