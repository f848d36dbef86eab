"""Maps that robots find their way with: vector maps, and navigation graphs of buildings."""
