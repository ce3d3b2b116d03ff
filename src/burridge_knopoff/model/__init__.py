"""The mechanical model: chain, friction law, driver and contact; initial states and states at an instant."""
