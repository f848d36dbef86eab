"""What a robot sees: colour models, blobs, what stands on the table in head pictures."""
