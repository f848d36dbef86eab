"""What people say that robots are to do, in plain English: as requests, or what to ask back."""
