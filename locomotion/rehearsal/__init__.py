"""Looking ahead: trying out what a person is about to do, before it does it."""
