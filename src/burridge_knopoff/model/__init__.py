"""What moves: chain, friction law, driver and contact, and the states that they can be in."""
