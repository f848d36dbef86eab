"""Reports, of a run and of a fleet: self-contained HTML files, written from events."""
