"""Who is where, who gives way to whom, and who gets nowhere."""
