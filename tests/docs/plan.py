"""Sorts the commands of the pages by the lists: run, described (checked by the help), left out."""
import dataclasses
import re

RUNNABLE = re.compile(r"^(dssbench|.*/dssbench|make|cmake|ctest|mpirun|eval|cp|plots/\S+\.py)$")


@dataclasses.dataclass(frozen=True)
class Lists:
    """What lists.py holds, and what self_test.py plants in its place."""
    left_out: tuple = ()      # (pattern of the text, reason)
    replaced: tuple = ()      # (pattern, replacement, reason), applied in this order
    placeholders: tuple = ()  # words that stand for something else
    own_lines: tuple = ()     # (pattern of a line in a transcript, reason)
    transcripts: tuple = ()   # as `replaced`, for transcripts: others are run as shown


@dataclasses.dataclass
class Plan:
    """Each distinct command once, in the pages' order."""
    run: list = dataclasses.field(default_factory=list)        # (command, text as it is run)
    described: list = dataclasses.field(default_factory=list)  # commands
    left_out: list = dataclasses.field(default_factory=list)   # (command, reason)
    faults: list = dataclasses.field(default_factory=list)     # sentences


def distinct(commands):
    """Equal commands once: the first with a transcript, or else the first."""
    found = {}
    for command in commands:
        key = (command.text, command.exit_code, command.is_short)
        if key not in found or (command.output and not found[key].output):
            found[key] = command
    return list(found.values())


def make_plan(commands, lists):
    """What to do with each command; faults are unknown commands and stale entries of the lists."""
    plan, used, texts = Plan(), set(), set()
    for command in distinct(commands):
        reason = why_left_out(command, lists, used)
        text = replaced(command, lists, used)
        if reason:
            plan.left_out.append((command, reason))
        elif is_described(command, text, lists):
            plan.described.append(command)
        elif not RUNNABLE.match(command.words()[0]):
            plan.faults.append(f"{command.place()}: `{command.text}` is neither run nor left out")
        elif (text, command.exit_code) not in texts:
            texts.add((text, command.exit_code))
            plan.run.append((command, text))
    used |= {entry for entry in lists.own_lines
             if any(re.search(entry[0], line) for command in commands for line in command.output)}
    plan.faults += [f"lists.py: {entry[0]!r} fits no command of the pages"
                    for entry in all_entries(lists)
                    if entry not in used]
    return plan


def all_entries(lists):
    return lists.left_out + lists.replaced + lists.transcripts + lists.own_lines


def why_left_out(command, lists, used):
    """The reason of the first entry that fits, or an empty string."""
    for entry in lists.left_out:
        if re.search(entry[0], command.text):
            used.add(entry)
            return entry[1]
    return ""


def replaced(command, lists, used):
    """The text with smaller sizes."""
    text = command.text
    for entry in lists.transcripts if command.output else lists.replaced:
        smaller = re.sub(entry[0], entry[1], text)
        if smaller != text:
            used.add(entry)
        text = smaller
    return text


def is_described(command, text, lists):
    """True of names, synopses, and of what has a placeholder without a value."""
    words = "|".join(lists.placeholders)
    has_placeholder = bool(words) and re.search(rf"(?<![\w=$-])({words})(?!\w)", text)
    return bool(command.is_name() or command.is_synopsis() or command.is_short or has_placeholder)
