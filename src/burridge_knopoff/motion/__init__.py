"""What kind of motion a trajectory settles on: its section returns, period, exponents and observables."""
