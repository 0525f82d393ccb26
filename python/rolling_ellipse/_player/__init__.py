"""The player of films in a browser, and the blows that a reader can try there."""

from .._pictures.animation import animate
from .explorer import Explorer, explore
from .film import film_html, film_page

__all__ = ["Explorer", "animate", "explore", "film_html", "film_page"]
