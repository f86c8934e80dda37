"""Verb ``gearfe signal``: channels of files, their spectra, and the condition indicators of a gear."""

import math
import os
import shlex
import sys
import warnings
from dataclasses import replace
from pathlib import Path

OTHER = 0.05  # relative difference of speeds from which a tachometer is on another shaft, or the record at another speed
SHARP = 0.8  # least part of the amplitude around the mesh frequency that its line must have
NEAR = 0.01  # relative distance from the mesh frequency within which its line is looked for
PRINTED = 30  # largest number of printed spectral lines


def signal(arguments):
    """Run ``gearfe signal``."""
    from ...comparison.vibration import analyse
    from ...core.steps import part
    from .progress import working
    from .verbs import print_analysis

    _of_scene(arguments)
    if arguments.list:
        _print_channels(arguments)
        return
    _check(arguments)
    if any(os.path.isdir(file) for file in arguments.file):
        _trend(arguments)
        return
    if arguments.case is not None and (arguments.gear is None or arguments.teeth is None):
        raise ValueError("--case simulates the machine of a gear: give --scene, --gear and --case")
    with working("reading"):
        with part("", 0.0, 0.5):
            signals = _read(arguments)
        with part("spectra and indicators", 0.5, 1.0):
            analysed = analyse(signals, arguments.mesh, arguments.fault, carrier=arguments.carrier, channel=", ".join(signals))
    for name, record in signals.items():
        print(_told(record))
        _compare_speed(record, arguments)
        if arguments.mesh is not None:
            _check_mesh_line(name, analysed.spectra[name], analysed.lines)
    print_analysis(analysed, arguments)
    tables = {"indicators": analysed.indicators_table()}
    if arguments.scene is not None:
        named, large = _named_lines(list(analysed.spectra.values())[-1], arguments)
        tables[named] = large
        print(f"\n{named}\n\n{large}")
    verdict, extra = _of_gear(signals, arguments, tables, analysed) if arguments.teeth is not None else ("", {})
    if arguments.output:
        from ...reports.workbench import signal_workbench

        options = {"teeth": arguments.teeth, "fault": arguments.fault, "verdict": verdict, "tables": tables}
        with working("pictures and tables"):
            page = signal_workbench(signals, arguments.output, simulated=extra, command=_command(), **options)
        print(f"written: {page}")
    _draw(list(signals.values())[-1], arguments)
    if arguments.orders:
        _draw_orders(signals, arguments)


def _check(arguments):
    for option in ("teeth", "orders"):
        if getattr(arguments, option) is not None and not (arguments.shaft or arguments.tacho or arguments.speeds):
            raise ValueError(f"--{option} needs the shaft frequency of that gear: give --shaft HZ, --tacho COLUMN or --speeds")
    if arguments.speeds and (arguments.teeth is None or arguments.tacho is not None):
        raise ValueError("--speeds estimates the speed of a gear from its mesh lines: give --teeth, and no --tacho")
    if arguments.pulses < 1:
        raise ValueError(f"--pulses {arguments.pulses}: give 1 or more pulses per revolution")


def _named_lines(spectrum, arguments):
    """Return title and table of the largest lines of a spectrum, named by the scene. The output file contains all lines."""
    from ...comparison.named_lines import named_table
    from ...scene.load import load_scene

    table, named = named_table(spectrum, load_scene(arguments.scene))
    large = replace(table, rows=sorted(sorted(table.rows, key=lambda row: -row[1])[:PRINTED]))
    if arguments.output:
        Path(arguments.output).mkdir(parents=True, exist_ok=True)
        table.save(Path(arguments.output) / "lines.csv")
    more = f"; the {PRINTED} largest are shown, all are in lines.csv of -o" if len(large.rows) < len(table.rows) else ""
    return named + more, large


def _of_gear(signals, arguments, tables, analysed):
    """Print condition indicators and the verdict for one gear, and add the tables.

    Returns the verdict and simulated records.
    """
    from ...comparison.simulated import simulated_gear
    from ...scene.load import load_scene
    from ...signal.gear_indicators import gear_indicator_table, tabulate_gear_indicators
    from ...signal.tooth_verdict import tooth_verdict
    from .progress import working

    simulated = {}
    if arguments.case is not None:
        with working("simulated machine"):
            simulated = simulated_gear(load_scene(arguments.scene), arguments.case, arguments.gear)
    parts = {"": signals, ", simulated mesh force": simulated}
    for told, records in parts.items():
        if records:
            table = tabulate_gear_indicators(gear_indicator_table(records, arguments.teeth))
            tables[heading := f"gear of {arguments.teeth} teeth, from its synchronous average (TSA){told}"] = table
            print(f"\n{heading}\n\n{table}")
    said = []
    for told, records in parts.items():
        if records:
            healthy, *others = records.values()
            try:
                verdict = tooth_verdict(others[-1] if others else healthy, arguments.teeth, healthy if others else None)
                beside = analysed.beside_verdict() if verdict.level == "not seen" and not told else ""
                said.append(f"{told[2:]}: " * bool(told) + verdict.told(arguments.teeth) + beside)
            except ValueError as error:
                print(f"\nno verdict: {error}")
    print("", *said, sep="\n")
    return " ".join(said), simulated


def _command():
    """Return the command line as it was given."""
    return shlex.join(["gearfe", *sys.argv[1:]])


def _trend(arguments):
    """Print the indicators of all records of folders in the order of their names, and save them."""
    from ...core.files import suffixes
    from ...figures.vibration_plots import plot_trend
    from ...reports.workbench import trend_table
    from ...signal.gear_indicators import gear_indicator_table
    from .progress import working

    known = tuple(suffixes("signal", reading=True))
    folders = [Path(folder) for folder in arguments.file]
    arguments.file = [str(one) for folder in folders for one in sorted(folder.iterdir()) if one.name.lower().endswith(known)]
    if not arguments.file:
        raise ValueError(f"{', '.join(map(str, folders))}: no records; give a folder with {', '.join(known)}")
    with working("reading"):
        signals = _read(arguments)
    rows = {name: {"rms": (of := one.indicators())["rms"], "kurtosis": of["kurtosis"]} for name, one in signals.items()}
    if arguments.teeth is not None:
        of_gear = gear_indicator_table(signals, arguments.teeth)
        rows = {name: row | {key: of_gear[name][key] for key in ("FM4", "NA4", "energy ratio")} for name, row in rows.items()}
    table = trend_table(rows)
    print(table)
    if arguments.output:
        folder = Path(arguments.output)
        folder.mkdir(parents=True, exist_ok=True)
        table.save(folder / "trend.csv")
        plot_trend(rows, folder / "trend.png")
        print(f"written: {folder / 'trend.csv'}, {folder / 'trend.png'}")


def _of_scene(arguments):
    """Set missing frequencies and the number of teeth to those of a gear of a scene."""
    if arguments.gear is None:
        return
    if arguments.scene is None:
        raise ValueError("--gear names a gear of a scene: give --scene, too")
    from ...dynamics.machine.lines import gear_lines
    from ...scene.load import load_scene

    found = gear_lines(load_scene(arguments.scene), arguments.gear)
    own = {"mesh": found.mesh, "fault": found.fault, "carrier": found.carrier, "teeth": found.teeth}
    arguments.turning = found.turning
    if arguments.tacho is None and arguments.speeds is None:
        own["shaft"] = found.turning
    for name, value in own.items():
        if getattr(arguments, name) is None:
            setattr(arguments, name, value)
    shown = ", ".join(f"{name} {value:.6g} Hz" for name, value in own.items() if value is not None and name != "teeth")
    print(f"{arguments.gear} of {arguments.scene}, {found.teeth} teeth: {shown}\n")


def _compare_speed(one, arguments):
    """Warn if the tachometer's shaft and the gear of the scene have different speeds."""
    if arguments.gear is None or arguments.tacho is None:
        return
    found, stated = float(one.angle[-1] - one.angle[0]) / (2 * math.pi * float(one.time[-1] - one.time[0])), arguments.turning
    if abs(found / stated - 1) > OTHER:
        warnings.warn(
            f"the tachometer gives {found:.4g} Hz for the shaft of {arguments.gear}, which has {stated:.4g} Hz in the scene: "
            f"give --tacho-ratio {arguments.tacho_ratio * stated / found:.5g} if the tachometer is on another shaft",
            stacklevel=1,
        )


def _check_mesh_line(name, spectrum, lines):
    """Warn if a varying speed spreads the mesh line, or if the line is at another frequency than the one given."""
    from ...signal.spectral_lines import BINS, line_part

    mesh, step = lines["f_m"], spectrum.resolution
    apart = min((abs(other - mesh) for key, other in lines.items() if key != "f_m"), default=mesh)
    reach = min(max(NEAR * mesh, 3 * BINS * step), apart / 2)
    if reach < 3 * BINS * step or mesh + 3 * reach > spectrum.frequency[-1] or mesh < 3 * reach:
        return
    part, largest, sharp = line_part(spectrum, mesh, reach)
    if not part < SHARP:
        return
    given = f"{name}: the line at --mesh {mesh:.6g} Hz has {100 * part:.2g} % of the amplitude within {reach:.3g} Hz"
    if sharp >= SHARP:
        remedy = f"the largest line is at {largest:.6g} Hz: give the mesh frequency at the speed of this record, or --carrier"
    else:
        remedy = "the speed varies: give --teeth with --tacho or --speeds, and read order spectra (--orders)"
    warnings.warn(f"{given}, because {remedy}", stacklevel=1)


def _told(one):
    """Return one line on a record: samples, rate, length, and revolutions of the shaft."""
    import numpy as np

    text = f"{one.name}: {one.values.size} samples at {one.rate:.7g} Hz, {one.duration:.4g} s"
    if one.angle is None:
        return text
    turns = float(one.angle[-1] - one.angle[0]) / (2 * np.pi)
    if turns < 2:
        return f"{text}; shaft: {turns:.2g} revolutions"
    whole = np.interp(one.angle[0] + 2 * np.pi * np.arange(int(turns) + 1), one.angle, one.time)
    speed = 1 / np.diff(whole)
    text += f"; shaft: {speed.min():.4g} to {speed.max():.4g} Hz, {turns:.1f} revolutions"
    # The speed change smears the first order over more than one bin.
    smeared = (speed.max() - speed.min()) * turns > speed.mean()
    return f"{text}; lines are smeared over Hz, but sharp over orders (--orders)" if smeared else text


def _print_channels(arguments):
    """Print the channels of each file."""
    from ...signal.found import ANGLES, TIMES
    from ...signal.signal_file import channels

    for file in arguments.file:
        recording = channels(file, arguments.header)
        print(file)
        for name in recording.channels():
            rate = f", {recording.rates[name]:g} Hz" if name in recording.rates else ""
            print(f"  {name} [{recording.units.get(name) or 'no unit'}]: {recording.vectors[name].size} samples{rate}")
        for name in [*recording.axes(TIMES), *recording.axes(ANGLES)]:
            values = recording.vectors[name]
            print(f"  {name} [{recording.units.get(name) or 'no unit'}]: from {values[0]:.9g} to {values[-1]:.9g}")
        for name, value in recording.stated.items():
            print(f"  stated: {name} = {value}")
        for text in recording.other:
            print(f"  not read: {text}")


def _read(arguments):
    """Read the chosen channel of every file by name, with the shaft angle or the shaft frequency if known."""
    from ...core.steps import steps
    from ...signal.shaft_speed import with_estimated_speed
    from ...signal.signal_file import read_signals

    out = {}
    for file in steps(arguments.file, lambda file: f"reading {file}"):
        channels = read_signals(
            file, None if arguments.column is None else [arguments.column], units=arguments.unit, rate=arguments.rate,
            header=arguments.header, scale=arguments.scale, tachometer=arguments.tacho, pulses=arguments.pulses,
            ratio=arguments.tacho_ratio,
            level=arguments.level,
        )  # fmt: skip
        if len(channels) > 1:
            raise ValueError(f"{file}: {len(channels)} channels, {', '.join(map(repr, channels))}: choose one by --column")
        (channel,) = channels.values()
        if channel.name in out:
            raise ValueError("two files have the same name: their cases could not be distinguished; rename one")
        channel = channel.between(arguments.start, arguments.stop)
        if arguments.speeds:
            channel = with_estimated_speed(replace(channel, angle=None, shaft_frequency=None), arguments.teeth, arguments.speeds)
        elif arguments.shaft is not None and channel.angle is None:
            channel = replace(channel, shaft_frequency=arguments.shaft)
        out[channel.name] = channel
    return out


def _draw(one, arguments):
    """Draw cepstrum and spectrogram of the last case."""
    from ...figures.vibration_plots import plot_cepstrum, plot_spectrogram
    from ...signal.time_frequency import cepstrum, spectrogram

    pictures = (arguments.cepstrum, plot_cepstrum, cepstrum), (arguments.spectrogram, plot_spectrogram, spectrogram)
    for path, draw, of in pictures:
        if path:
            draw(of(one), path, one.name)
            print(f"written: {path}")


def _draw_orders(signals, arguments):
    """Draw order spectra of the shaft, with the lines of the gear's mesh if its teeth are given."""
    from ...figures.vibration_plots import plot_spectra
    from ...signal.orders import order_spectrum
    from ...signal.spectral_lines import expected_lines

    lines = expected_lines(arguments.teeth, 1.0, count=2, harmonics=2) if arguments.teeth else {"f_fault": 1.0}
    named = {name.replace("f_m", "mesh").replace("f_fault", "turn"): order for name, order in lines.items()}
    spectra = {name: order_spectrum(record) for name, record in signals.items()}
    plot_spectra(spectra, named, arguments.orders, top=None if arguments.teeth else spectra[next(iter(spectra))].frequency[-1])
    print(f"written: {arguments.orders}")
