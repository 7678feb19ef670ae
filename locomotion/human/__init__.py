"""The person, put together from body, gaits, skills, recovery and rehearsal."""
