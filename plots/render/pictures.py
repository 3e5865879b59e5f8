"""Writes figures. Each is checked, and a PNG notes what made it.

A figure of a table has the commit and the time of its record in raw/. Any other figure has the
commit and the time of drawing: the time of a file is only when git checked it out.
"""
import datetime
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEY = "Source"  # a keyword of the PNG standard


def revision():
    """The commit of this tree, if git knows."""
    command = ["git", "-C", str(ROOT), "rev-parse", "--short=9", "HEAD"]
    try:
        result = subprocess.run(command, capture_output=True, text=True)
    except OSError:
        return ""
    return result.stdout.strip() if result.returncode == 0 else ""


def drawn_now():
    """The note in a figure without a record."""
    now = datetime.datetime.now(datetime.timezone.utc)
    return f"drawn by commit {revision() or 'unknown'}, {now:%Y-%m-%d %H:%M} UTC"


def measured_by(directory, table):
    """The note in a figure of DIR/tables/TABLE.csv; empty if raw/ has no record of it."""
    from tables.age import Record  # needs pandas; pictures of bodies do not
    from tables.results import study_of
    try:
        known = Record(pathlib.Path(directory) / "raw" / f"{study_of(table)}.json")
    except (OSError, LookupError, ValueError, TypeError, AttributeError):
        return ""
    return f"measured by {known.made_by(known.last)}"


def save(figure, output, source, **more):
    """Checks and writes a figure. source: the note in a PNG

    @throws check.Unreadable after the figure is written, so that one can look at it
    """
    from . import check
    is_png = pathlib.Path(output).suffix.lower() == ".png"
    pathlib.Path(output).parent.mkdir(parents=True, exist_ok=True)
    found = check.violations(figure)
    figure.savefig(output, metadata={KEY: source} if is_png and source else None, **more)
    if found:
        raise check.Unreadable("\n".join(f"{output}: {text}" for text in found))


def made_by(path):
    """The note in a PNG, or that its age is unknown."""
    from PIL import Image  # comes with Matplotlib
    try:
        with Image.open(path) as picture:
            return picture.info.get(KEY) or "age unknown"
    except (OSError, ValueError, SyntaxError):
        return "age unknown"
