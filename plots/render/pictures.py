"""PNG files: each is checked when it is written, and says what made it.

A picture of a table says what its record in raw/ says; one of anything else, who drew it and
when. The time of a file is when git checked it out.
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
    """For pictures that no record is behind."""
    now = datetime.datetime.now(datetime.timezone.utc)
    return f"drawn by commit {revision() or 'unknown'}, {now:%Y-%m-%d %H:%M} UTC"


def measured_by(directory, table):
    """What DIR/raw/NAME.json says of DIR/tables/NAME.csv; empty if there is none."""
    from tables.age import Record  # needs pandas, which pictures of bodies do without
    from tables.results import study_of
    try:
        known = Record(pathlib.Path(directory) / "raw" / f"{study_of(table)}.json")
    except (OSError, LookupError, ValueError, TypeError, AttributeError):
        return ""
    return f"measured by {known.made_by(known.last)}"


def save(figure, output, source, **more):
    """Checks and writes a figure; only PNG files say where they are from.

    @throws check.Unreadable after writing it, so that one can look at what is wrong
    """
    from . import check
    is_png = pathlib.Path(output).suffix.lower() == ".png"
    pathlib.Path(output).parent.mkdir(parents=True, exist_ok=True)
    found = check.violations(figure)
    figure.savefig(output, metadata={KEY: source} if is_png and source else None, **more)
    if found:
        raise check.Unreadable("\n".join(f"{output}: {text}" for text in found))


def made_by(path):
    """The line in a PNG; says so if there is none."""
    from PIL import Image  # comes with Matplotlib
    try:
        with Image.open(path) as picture:
            return picture.info.get(KEY) or "age unknown"
    except (OSError, ValueError, SyntaxError):
        return "age unknown"
