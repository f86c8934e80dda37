"""Parts that several pages share: machine, tables, references, simulations."""
