"""What several pages use: machine, tables, references, simulations."""
