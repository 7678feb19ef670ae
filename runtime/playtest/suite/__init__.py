"""A night's work: playtests of many levels, with many characters and seeds, and one report of them all."""
