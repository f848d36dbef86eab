"""The service's doors: REST, the helpers' WebSocket, metrics and the helper console."""
