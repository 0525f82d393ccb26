"""The player of films in a browser, and the blows that a reader tries there."""

from .film import film_html, film_page

__all__ = ["film_html", "film_page"]
