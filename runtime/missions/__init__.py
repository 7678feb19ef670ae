"""Missions: what agents are told to do, and what is expected of them."""
