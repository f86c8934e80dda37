"""The verbs that fill folders: ``gearfe sweep``, all cases of a study, and ``gearfe dataset``, labelled vibration windows."""

from .progress import working


def sweep(arguments):
    """Run ``gearfe sweep``."""
    from ...runs.sweeps.run import plan_sweep
    from ...runs.sweeps.run import sweep as run

    if arguments.dry_run:
        with working("trying one block"):
            plan = plan_sweep(arguments.study, arguments.output, workers=arguments.workers)
        print(plan.text())
        if plan.tried and plan.failed == plan.tried:
            raise ValueError(f"all {plan.tried} cases that were tried failed: {plan.error}")
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
    if not (table["status"] == "done").any():
        raise ValueError(f"all {len(table)} cases failed: {table['error'].iloc[0]}")


def dataset(arguments):
    """Run ``gearfe dataset``."""
    from ...runs.datasets.make import dataset as run
    from ...runs.datasets.make import plan_dataset

    if arguments.dry_run:
        with working("trying one condition"):
            cost = plan_dataset(arguments.plan, arguments.output, arguments.workers)
        print(cost.text())
        return
    with working("data set"):
        data_set = run(arguments.plan, arguments.output, also=arguments.also, workers=arguments.workers)
    labels = data_set.labels()
    print(f"{data_set.about['title']}: {len(labels)} windows of {labels['condition'].nunique()} conditions")
    for (fault, gear, severity), part in labels.fillna({"gear": ""}).groupby(["fault", "gear", "severity"]):
        sides = ", ".join(f"{(part['side'] == side).sum()} {side}" for side in ("train", "validation", "test"))
        label = fault if fault == "healthy" else " ".join(filter(None, (fault, gear, f"{severity:g}")))
        print(f"  {label:16s} {sides}; largest loss of stiffness {100 * part['loss_max'].mean():z.1f} %")
    lost = data_set.failed()
    if lost:
        print(f"  {len(lost)} conditions could not be simulated, the first: {next(iter(lost.values()))}")
    print(f"written: {arguments.output}, described in card.md")
    print(f"  in Python: gearfe.open_dataset({str(arguments.output)!r}).windows({{'side': 'train'}})")
