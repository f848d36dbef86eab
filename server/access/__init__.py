"""Who may do what here: principals and their roles, tokens, sessions, and the deeds of each."""
