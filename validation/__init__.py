"""What the literature and independent solvers report, and how close gearfe is."""
