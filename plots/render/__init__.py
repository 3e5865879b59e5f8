"""The renderers of a Chart: PNG files (png.py) and the page (page.py)."""
