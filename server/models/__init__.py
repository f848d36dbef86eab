"""What robots are drawn from: model files that come with Mend, and those that were uploaded."""
