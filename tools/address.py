"""Write the project's public address into every file that needs it: python tools/address.py URL

URL is the address of the repository, such as https://host/owner/rolling-ellipse; its branch is
`main`. Until the address is known, the README has relative links, which PyPI cannot follow. A
second run with another address replaces the first one. --site is the address of the built site, by
default that of the repository. --maintainers are the accounts that maintain the recipe, by default
the owner of the repository.
"""

import argparse
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LINK = re.compile(
    r"(!?)\[([^\]]*)\]\((?:https?://[^)\s]*?/(?:raw|blob)/main/)?(?!https?:|#)([^)\s]+)\)"
)


def readme(text: str, address: str) -> str:
    """The text with absolute links; links to pictures lead to the raw files."""

    def absolute(found: re.Match[str]) -> str:
        kind = "raw" if found[1] else "blob"
        return f"{found[1]}[{found[2]}]({address}/{kind}/main/{found[3]})"

    return LINK.sub(absolute, text)


def with_urls(text: str, address: str, site: str) -> str:
    """The text of pyproject.toml with a table of the project's addresses."""
    table = (
        f'[project.urls]\nHomepage = "{site}"\nRepository = "{address}"\n'
        f'Issues = "{address}/issues"\nChangelog = "{address}/blob/main/CHANGELOG.md"\n\n'
    )
    text = re.sub(r"\[project\.urls\]\n(?:\w+ = .*\n)+\n", "", text)
    return text.replace("[project.scripts]\n", table + "[project.scripts]\n")


def with_field(text: str, field: str, value: str, before: str) -> str:
    """YAML with a field added before a line, indented like that line."""
    text = re.sub(rf"^ *{field}: .*\n", "", text, flags=re.MULTILINE)
    return re.sub(rf"^( *){before}", rf"\g<1>{field}: {value}\n\g<0>", text, flags=re.MULTILINE)


def with_reports(text: str, address: str) -> str:
    """The text with an absolute link to the form for private reports."""
    return re.sub(r"\([^()\s]+(/security/advisories/new\))", rf"({address}\g<1>", text)


def recipe(text: str, address: str, site: str, maintainers: list[str]) -> str:
    text = with_field(text, "repository", address, "license: ")
    text = with_field(text, "homepage", site, "license: ")
    listed = "".join(f"    - {name}\n" for name in maintainers)
    return re.sub(r"(recipe-maintainers:\n)(?: +- .+\n)+", rf"\g<1>{listed}", text)


def write(root: Path, address: str, site: str, maintainers: list[str]) -> None:
    changes = {
        "README.md": lambda text: readme(text, address),
        "pyproject.toml": lambda text: with_urls(text, address, site),
        "CITATION.cff": lambda text: with_field(text, "repository-code", address, "license: "),
        "recipe/recipe.yaml": lambda text: recipe(text, address, site, maintainers),
        "SECURITY.md": lambda text: with_reports(text, address),
        "CODE_OF_CONDUCT.md": lambda text: with_reports(text, address),
    }
    for name, change in changes.items():
        path = root / name
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")


def main() -> None:
    options = argparse.ArgumentParser(usage="%(prog)s URL [--site URL] [--maintainers NAME …]")
    options.add_argument("url")
    options.add_argument("--site", help="address of the built site; without it, the repository")
    options.add_argument("--maintainers", nargs="+", help="accounts; without it, the owner")
    chosen = options.parse_args()
    address = chosen.url.rstrip("/")
    if not re.fullmatch(r"https://[\w.-]+(/[\w.-]+)+", address):
        options.error(f"URL must be like https://host/owner/name, got {chosen.url!r}")
    owner = address.split("/")[3]
    write(ROOT, address, (chosen.site or address).rstrip("/"), chosen.maintainers or [owner])


if __name__ == "__main__":
    main()
