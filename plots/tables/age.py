"""What made the records, when, and which of them are old.

raw/NAME.json says which program measured raw/NAME.csv, each row there when. A record is old if another commit made it than the newest ones, or another machine, or
if it is of an earlier session. Of a table without a record nothing is known: the time of its file is when it was checked out or copied.
"""
import datetime
import json

import pandas

from .results import study_of

# Studies of one session follow each other; those that leave only their last time take up to an hour in between.
SESSION_GAP = datetime.timedelta(hours=2)
# Within a study one repetition follows the other: a longer pause is a run that was cut off, and one with --resume after it.
PAUSE = datetime.timedelta(minutes=2)


class Record:
    """One raw/NAME.json with the times of raw/NAME.csv."""

    def __init__(self, path):
        text = json.loads(path.read_text(encoding="utf-8"))
        self.name, self.context = path.stem, text["context"]
        self.scale, self.title = text.get("scale", ""), text.get("title", "")
        self.commit = str(self.context.get("git_commit", ""))
        self.is_dirty = bool(self.context.get("git_dirty"))
        self.reasons = []
        self.resumptions = sorted(pandas.to_datetime(text.get("resumed_utc", []), utc=True))
        self._read_times(path.with_suffix(".csv"))

    def _read_times(self, path):
        times, longest = [pandas.Timestamp(self.context["date"])], 0.0
        if path.exists():
            rows = pandas.read_csv(path, usecols=lambda column: column in ("time_utc", "process_s"))
            if "time_utc" in rows and rows["time_utc"].notna().any():
                times = sorted(pandas.to_datetime(rows["time_utc"].dropna(), utc=True))
                longest = float(rows["process_s"].max()) if "process_s" in rows and rows["process_s"].notna().any() else 0.0
        self.first, self.last, self.count = times[0], times[-1], len(times)
        pause = PAUSE + 3 * datetime.timedelta(seconds=longest)
        # Newer records say when they were gone on with; of older ones a pause tells.
        told = [sum(time < resumed for time in times) for resumed in self.resumptions]
        breaks = [place for place in told if 0 < place < len(times)] if self.resumptions else [place for place in range(1, len(times)) if times[place] - times[place - 1] > pause]
        self.kept = breaks[-1] if breaks else 0  # rows before the last pause
        self.kept_until, self.resumed = (times[breaks[-1] - 1], times[breaks[-1]]) if breaks else (None, None)

    def kept_text(self):
        if not self.kept:
            return ""
        pause = (self.resumed - self.kept_until).total_seconds() / 60
        return (f"{self.kept} of {self.count} records are old: of {day(self.first)} to {day(self.kept_until)}, kept by --resume when measuring went on {pause:.0f} minutes later, "
                f"{day(self.resumed)}")

    def made_by(self, time=None):
        return f"commit {self.commit[:9] or 'unknown'}{' with uncommitted changes' if self.is_dirty else ''}, {day(time or self.first)}"


def day(time):
    return f"{time:%Y-%m-%d %H:%M} UTC"


class Ages:
    """All records of a directory, newest first."""

    def __init__(self, directory):
        self.directory, self.records, self.unreadable = directory, {}, []
        for path in sorted((directory / "raw").glob("*.json")):
            try:
                record = Record(path)
            except (ValueError, KeyError, TypeError, AttributeError):
                self.unreadable.append(path.name)  # such as devices.json, which no study wrote
                continue
            self.records[record.name] = record
        ordered = sorted(self.records.values(), key=lambda record: record.last, reverse=True)
        self.newest = ordered[0] if ordered else None
        self.session_start = self._session_start(ordered)
        for record in ordered:
            record.reasons = self._reasons(record)

    def _session_start(self, ordered):
        start = None
        for record in ordered:
            begins = record.resumed or record.first
            if start is None or (record.last >= start - SESSION_GAP and record.commit == self.newest.commit):
                start = begins if start is None else min(start, begins)
        return start

    def _reasons(self, record):
        newest, reasons = self.newest, []
        if record.commit != newest.commit:
            reasons.append(f"made by commit {record.commit[:9]}, the newest ({newest.name}) by {newest.commit[:9]}")
        for key, word in (("cpu_model", "machine"), ("compiler", "compiler")):
            if record.context.get(key) != newest.context.get(key):
                reasons.append(f"another {word}: {record.context.get(key)}")
        if not reasons and record.last < self.session_start - SESSION_GAP:
            reasons.append(f"of an earlier session than the newest ({newest.name}, {day(newest.last)})")
        return reasons

    def line(self, table):
        """(is it old, one line on what made a table)."""
        study = study_of(table)
        record = self.records.get(study)
        if record is None:
            return False, f"age unknown: no raw/{study}.json says which commit made it, and when."
        text = [f"old: of {day(record.first)}; {'; '.join(record.reasons)}." if record.reasons else f"Made by {record.made_by()}."]
        if record.kept:
            text.append(record.kept_text() + ".")
        return bool(record.reasons or record.kept), " ".join(text)

    def unknown(self):
        """Tables that no record tells of."""
        return [name for name in sorted(path.stem for path in (self.directory / "tables").glob("*.csv")) if study_of(name) not in self.records]

    def old(self):
        """(name, why) of each record that is old, wholly or in part."""
        return [(record.name, "; ".join([*record.reasons, *([record.kept_text()] if record.kept else [])])) for record in self.records.values() if record.reasons or record.kept]
