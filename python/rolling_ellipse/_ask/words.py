"""Texts of reasons and web pages by key, from one JSON file per language in this folder."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache

LANGUAGES = ("en", "de")
BRACES = re.compile(r"\{(\w+)\}")

Sentence = tuple[str, list[tuple[str, float]]]  # the key of a text, and its placeholders' values


@cache
def table(language: str) -> dict[str, str]:
    """Return the texts of a language by key, with placeholders in braces."""
    from json import loads  # json and pathlib take a tenth of the package's import time
    from pathlib import Path

    file = Path(__file__).with_name(f"words_{language}.json")
    return loads(file.read_text(encoding="utf-8"))


def written(value: float, words: Mapping[str, str], digits: int = 4) -> str:
    """Return a number as text, with the decimal separator of the language."""
    text = f"{value:.{digits}g}".replace("inf", "∞").replace("-", "−")
    return text.replace(".", words["decimal"])


def joined(words: Mapping[str, str], sentences: Sequence[Sentence], digits: int) -> str:
    """Return the sentences with these keys and values as one text."""
    return " ".join(filled(words, key, digits, **dict(numbers)) for key, numbers in sentences)


def filled(words: Mapping[str, str], key: str, digits: int = 4, **values: float) -> str:
    return BRACES.sub(lambda name: written(values[name[1]], words, digits), words[key])
