"""Ways to see a run: pictures, films, pages, live views, exports."""
