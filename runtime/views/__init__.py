"""What one sees of a run: pictures, films, pages, windows, files for engines."""
