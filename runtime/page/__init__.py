"""The page that plays a run: what it is given (`data`), and the HTML, CSS and JavaScript around that."""
