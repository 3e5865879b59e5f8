"""What made a picture, in the picture: PNG files carry a line with commit and date.

A picture of a table says what its record in raw/ says; one of anything else, who drew it and when. The time of a file is when git checked it out.
"""
import datetime
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEY = "Source"  # a keyword of the PNG standard


def revision():
    """The commit of this tree, if git knows."""
    try:
        result = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=9", "HEAD"], capture_output=True, text=True)
    except OSError:
        return ""
    return result.stdout.strip() if result.returncode == 0 else ""


def drawn_now():
    """For pictures of what no record tells of."""
    return f"drawn by commit {revision() or 'unknown'}, {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d %H:%M} UTC"


def measured_by(table):
    """What the record beside a table says, DIR/raw/NAME.json beside DIR/tables/NAME.csv; empty if there is none."""
    from .age import Record  # needs pandas, which pictures of bodies do without
    from .results import study_of
    table = pathlib.Path(table).resolve()
    try:
        known = Record(table.parents[1] / "raw" / f"{study_of(table.stem)}.json")
    except (OSError, LookupError, ValueError, TypeError, AttributeError):
        return ""
    return f"measured by {known.made_by(known.last)}"


def save(figure, output, source, **more):
    """Writes a figure; only PNG files say where they are from."""
    is_png = pathlib.Path(output).suffix.lower() == ".png"
    figure.savefig(output, metadata={KEY: source} if is_png and source else None, **more)


def made_by(path):
    """The line in a PNG; says so if there is none."""
    from PIL import Image  # comes with Matplotlib
    try:
        with Image.open(path) as picture:
            return picture.info.get(KEY) or "age unknown"
    except (OSError, ValueError, SyntaxError):
        return "age unknown"
