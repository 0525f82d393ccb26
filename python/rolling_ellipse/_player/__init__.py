"""The player of films in a browser, and the page on which blows can be tried."""

from .._pictures.animation import animate
from .explorer import Explorer, explore
from .film import film_html, film_page

__all__ = ["Explorer", "animate", "explore", "film_html", "film_page"]
