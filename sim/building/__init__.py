"""The world `building`: floors with doors, people, and robots that drive."""
