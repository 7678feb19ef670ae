"""Networks that correct what the planned gaits do."""
