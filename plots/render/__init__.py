"""The renderers of a chart's description: PNG files (png.py) and the page (page.py)."""
