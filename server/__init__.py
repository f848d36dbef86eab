"""The asyncio service: runs, live dialogues, journal, API and command line."""
