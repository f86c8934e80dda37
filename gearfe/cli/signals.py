"""The verb ``gearfe signal``: channels of files, what they show by frequency, and what a gear shows by its turns."""

from dataclasses import replace


def signal(arguments):
    """``gearfe signal``."""
    from ..steps import part
    from ..studies.vibration import analyse
    from .progress import working
    from .verbs import _check_outputs, _print_analysis

    _check_outputs(arguments, plot="picture", kurtogram="picture", cepstrum="picture", spectrogram="picture")
    if arguments.list:
        _print_channels(arguments)
        return
    if arguments.teeth is not None and arguments.shaft is None and arguments.tacho is None:
        raise ValueError("--teeth needs the turns of that gear's shaft: give --shaft HZ or --tacho COLUMN")
    if arguments.pulses < 1:
        raise ValueError(f"--pulses {arguments.pulses}: a tachometer gives one or more in a turn")
    with working("reading"):
        with part("", 0.0, 0.5):
            signals = _read(arguments)
        with part("spectra and indicators", 0.5, 1.0):
            found = analyse(signals, arguments.mesh, arguments.fault, carrier=arguments.carrier, channel=next(iter(signals)))
    _print_analysis(found, arguments)
    if arguments.teeth is not None:
        from ..signal.gear_indicators import gear_indicator_table, gear_table_text

        table = gear_indicator_table(signals, arguments.teeth)
        print(f"\ngear of {arguments.teeth} teeth, from the average of its turns\n\n{gear_table_text(table)}")
    _draw(list(signals.values())[-1], arguments)


def _print_channels(arguments):
    """What each file holds."""
    from ..signal.signal_file import channels

    for file in arguments.file:
        found = channels(file, arguments.header)
        print(file)
        for name in found.channels():
            rate = f", {found.rates[name]:g} Hz" if name in found.rates else ""
            print(f"  {name} [{found.units.get(name) or 'no unit'}]: {found.vectors[name].size} samples{rate}")
        for text in found.other:
            print(f"  not read: {text}")


def _read(arguments):
    """The chosen channel of every file by name, with the angle of the shaft or its frequency if they are known."""
    from ..signal.signal_file import read_signals
    from ..steps import steps

    out = {}
    for file in steps(arguments.file, lambda file: f"reading {file}"):
        found = read_signals(
            file, None if arguments.column is None else [arguments.column], units=arguments.unit, rate=arguments.rate,
            header=arguments.header, scale=arguments.scale, tachometer=arguments.tacho, pulses=arguments.pulses,
        )  # fmt: skip
        if len(found) > 1:
            raise ValueError(f"{file}: {len(found)} channels, {', '.join(map(repr, found))}: choose one by --column")
        (one,) = found.values()
        if one.name in out:
            raise ValueError("two files have the same name: their cases could not be told apart; rename one")
        turns = {"shaft_frequency": arguments.shaft} if arguments.shaft is not None and one.angle is None else {}
        out[one.name] = replace(one, **turns)
    return out


def _draw(one, arguments):
    """Cepstrum and spectrogram of the last case."""
    if arguments.cepstrum:
        from ..pictures.vibration_plots import plot_cepstrum
        from ..signal.time_frequency import cepstrum

        plot_cepstrum(cepstrum(one), arguments.cepstrum, one.name)
        print(f"written: {arguments.cepstrum}")
    if arguments.spectrogram:
        from ..pictures.vibration_plots import plot_spectrogram
        from ..signal.time_frequency import spectrogram

        plot_spectrogram(spectrogram(one), arguments.spectrogram, one.name)
        print(f"written: {arguments.spectrogram}")
