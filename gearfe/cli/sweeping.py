"""The verb ``gearfe sweep``: all cases of a study into a folder."""

from .progress import working


def sweep(arguments):
    """``gearfe sweep``."""
    from ..many.sweeps.plan import plan_sweep
    from ..many.sweeps.run import sweep as run

    if arguments.dry_run:
        with working("trying one block"):
            plan = plan_sweep(arguments.study, arguments.output, workers=arguments.workers)
        print(plan.text())
        return
    options = {"workers": arguments.workers, "scheduler": arguments.scheduler, "mixed": arguments.mixed}
    with working("sweep"):
        runs = run(arguments.study, arguments.output, **options)
    table = runs.table(["status", "error", "seconds"])
    count = table["status"].value_counts()
    print(f"{runs.about['title']}: {len(table)} cases, {', '.join(f'{n} {name}' for name, n in count.items())}")
    print(f"processor time {table['seconds'].sum():.4g} s, median of a case {table['seconds'].median():.3g} s")
    for text, n in table["error"].value_counts().head(3).items():
        print(f"  {n} times: {text}")
    print(f"written: {arguments.output}")
    print(f"  in Python: gearfe.open_runs({str(arguments.output)!r}).table()")
    print(f"  gearfe report {arguments.output} -o runs.html")
