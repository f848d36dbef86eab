"""What a robot sees: colour models, blobs, objects in head and forearm pictures."""
