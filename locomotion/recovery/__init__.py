"""After a fall: on hands and feet, and getting up."""
