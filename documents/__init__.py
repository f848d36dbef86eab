"""Files that people write: YAML and JSON read safely, their mistakes told with their lines."""
