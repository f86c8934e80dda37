"""The verb ``gearfe dataset``: labelled vibration windows into a folder."""

from .progress import working


def dataset(arguments):
    """``gearfe dataset``."""
    from ..many.datasets.make import dataset as run
    from ..many.datasets.size import size_of

    if arguments.dry_run:
        with working("trying one condition"):
            found = size_of(arguments.plan)
        print(found.text(arguments.workers))
        return
    with working("data set"):
        made = run(arguments.plan, arguments.output, also=arguments.also, workers=arguments.workers)
    labels = made.labels()
    print(f"{made.about['title']}: {len(labels)} windows of {labels['condition'].nunique()} conditions")
    for (fault, severity), part in labels.groupby(["fault", "severity"]):
        sides = ", ".join(f"{(part['side'] == side).sum()} {side}" for side in ("train", "validation", "test"))
        told = fault if fault == "healthy" else f"{fault} {severity:g}"
        print(f"  {told:16s} {sides}; largest loss of stiffness {100 * part['loss_max'].mean():.1f} %")
    lost = made.failed()
    if lost:
        print(f"  {len(lost)} conditions could not be simulated, the first: {next(iter(lost.values()))}")
    print(f"written: {arguments.output}, described in card.md")
    print(f"  in Python: gearfe.open_dataset({str(arguments.output)!r}).windows({{'side': 'train'}})")
