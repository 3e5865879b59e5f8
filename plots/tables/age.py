"""What made the records, when, and which of them are old.

raw/NAME.json says which program measured, and each row of raw/NAME.csv says when. A record is old
if a source that it depends on has changed since (sources.py), or if it was measured on another
machine or with another compiler than the newest record. Records of earlier programs do not name
their sources; they are old if their commit is not that of the newest record, or if they are of an
earlier session. The age of a table without a record is unknown: the time of a file is only when
the file was checked out or copied.
"""
import datetime
import json

import pandas

from .results import study_of
from .sources import changed

# The studies of a session follow each other. A study that records only its end takes up to an hour.
SESSION_GAP = datetime.timedelta(hours=2)
# The repetitions of a study follow each other. A longer pause is a run that was cut off, and went
# on with --resume.
PAUSE = datetime.timedelta(minutes=2)


def day(time):
    """A time to the minute."""
    return f"{time:%Y-%m-%d %H:%M} UTC"


class Record:
    """One raw/NAME.json with the times of raw/NAME.csv."""

    def __init__(self, path):
        text = json.loads(path.read_text(encoding="utf-8"))
        self.name, self.context = path.stem, text["context"]
        self.scale, self.sources = text.get("scale", ""), text.get("sources", {})
        self.commit = str(self.context.get("git_commit", ""))
        self.is_dirty = bool(self.context.get("git_dirty"))
        self.reasons = []  # why all of it is old; Ages compares records
        times, longest_s = self._read_times(path.with_suffix(".csv"))
        self.first, self.last, self.count = times[0], times[-1], len(times)
        resumptions = sorted(pandas.to_datetime(text.get("resumed_utc", []), utc=True))
        # Rows before the last pause. Only the same program on the same machine resumes a study that
        # names its sources: a reproduction measures some studies in parts.
        least_pause = SESSION_GAP if self.sources else datetime.timedelta(0)
        self.kept = kept_of(times, resumptions, longest_s, least_pause)
        self.kept_until = times[self.kept - 1] if self.kept else None
        self.resumed = times[self.kept] if self.kept else None

    def _read_times(self, path):
        """(times of all repetitions in order, longest duration of one [s])."""
        if path.exists():
            wanted = ("time_utc", "process_s")
            rows = pandas.read_csv(path, usecols=lambda column: column in wanted)
            rows = rows.reindex(columns=list(wanted))
            times = sorted(pandas.to_datetime(rows["time_utc"].dropna(), utc=True))
            if times:
                return times, rows["process_s"].fillna(0).max()
        return [pandas.Timestamp(self.context["date"])], 0

    def is_old(self):
        """All of the record, or a part of it, is old."""
        return bool(self.reasons or self.kept)

    def why_old(self):
        """All reasons in words."""
        return "; ".join([*self.reasons, *([self.kept_text()] if self.kept else [])])

    def kept_text(self):
        """What --resume kept, in words; empty if nothing."""
        if not self.kept:
            return ""
        pause_min = (self.resumed - self.kept_until).total_seconds() / 60
        return (f"{self.kept} of {self.count} records are old: of {day(self.first)} to "
                f"{day(self.kept_until)}, kept by --resume when measuring went on "
                f"{pause_min:.0f} minutes later, {day(self.resumed)}")

    def made_by(self, time=None):
        """The commit and the time of the first row, or another time."""
        changes = " with uncommitted changes" * self.is_dirty
        return f"commit {self.commit[:9] or 'unknown'}{changes}, {day(time or self.first)}"


def kept_of(times, resumptions, longest_s, least_pause=datetime.timedelta(0)):
    """The number of repetitions that the last --resume kept, after a pause of at least so long.

    Newer records say when they were resumed. In older ones a long pause shows it.
    """
    if resumptions:
        breaks = [sum(time < resumed for time in times) for resumed in resumptions]
    else:
        pause = PAUSE + 3 * datetime.timedelta(seconds=float(longest_s))
        breaks = [place for place in range(1, len(times))
                  if times[place] - times[place - 1] > pause]
    return next((place for place in reversed(breaks) if 0 < place < len(times)
                 and times[place] - times[place - 1] >= least_pause), 0)


class Ages:
    """All records of a directory by their names."""

    def __init__(self, directory):
        self.directory, self.records = directory, {}
        for path in sorted((directory / "raw").glob("*.json")):
            try:
                self.records[path.stem] = Record(path)
            except (ValueError, KeyError, TypeError, AttributeError):
                continue  # such as devices.json, which no study wrote
        self.newest = next(iter(self.newest_first()), None)
        self.session_start = self._session_start()
        for record in self.records.values():
            record.reasons = self._reasons(record)

    def newest_first(self):
        """All records, the newest first."""
        return sorted(self.records.values(), key=lambda record: record.last, reverse=True)

    def _session_start(self):
        """The start of the newest session: records of one commit that follow each other."""
        start = None
        for record in self.newest_first():
            begins = record.resumed or record.first
            if start is None:
                start = begins
            elif record.last >= start - SESSION_GAP and record.commit == self.newest.commit:
                start = min(start, begins)
        return start

    def _reasons(self, record):
        """Why all of a record is old."""
        newest, reasons = self.newest, []
        if record.sources:
            since = changed(record.sources, record.name)
            if since:
                reasons.append(f"made by commit {record.commit[:9]}; changed since: "
                               f"{', '.join(since)}")
        elif record.commit != newest.commit:
            reasons.append(f"made by commit {record.commit[:9]}, the newest ({newest.name}) by "
                           f"{newest.commit[:9]}")
        for key, word in (("cpu_model", "machine"), ("compiler", "compiler")):
            if record.context.get(key) != newest.context.get(key):
                reasons.append(f"another {word}: {record.context.get(key)}")
        if not reasons and not record.sources \
                and record.last < self.session_start - SESSION_GAP:
            reasons.append(f"of an earlier session than the newest ({newest.name}, "
                           f"{day(newest.last)})")
        return reasons

    def line(self, table):
        """(is it old, one line on what made a table)."""
        study = study_of(table)
        record = self.records.get(study)
        if record is None:
            return False, f"age unknown: no raw/{study}.json says which commit made it, and when."
        text = f"Made by {record.made_by()}."
        if record.reasons:
            text = f"old: of {day(record.first)}; {'; '.join(record.reasons)}."
        if record.kept:
            text += f" {record.kept_text()}."
        return record.is_old(), text

    def unknown(self):
        """Tables without a record."""
        tables = sorted(path.stem for path in (self.directory / "tables").glob("*.csv"))
        return [name for name in tables if study_of(name) not in self.records]

    def old(self):
        """(name, why) of each record that is old, wholly or in part."""
        return [(record.name, record.why_old()) for record in self.records.values()
                if record.is_old()]
