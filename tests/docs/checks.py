"""Checks one command: its exit code and the lines that it shows, or that the help describes it."""
import itertools
import re

import pages
import workplace

OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


def fault_of_run(command, text, lists, directory):
    """Why the command is not as its page states, or an empty string."""
    exit_code, output = workplace.finished(workplace.with_variants_here(text), directory)
    where = f"{command.place()}: `{command.text}`, run as `{text}`"
    if exit_code != command.exit_code:
        end = output[-2000:].rstrip()
        return f"{where}, ended with {exit_code} in place of {command.exit_code}:\n{end}"
    if text != command.text:
        return ""
    printed = {" ".join(line.split()) for line in output.splitlines()}
    missing = [line for line in command.output
               if " ".join(line.split()) not in printed and not is_own(line, lists)]
    return f"{where}, did not print {missing}; it printed:\n{output}" if missing else ""


def is_own(line, lists):
    """True if each machine prints such a line with other figures."""
    return any(re.search(entry[0], line) for entry in lists.own_lines)


def fault_of_description(command, help_of=workplace.help_of):
    """Why the help does not know what a page names, or an empty string."""
    words = list(itertools.dropwhile(lambda word: not pages.DSSBENCH.match(word),
                                     command.text.split()))
    if not words:
        return ""
    subcommand = next((word for before, word in itertools.pairwise(words)
                       if word[0].isalpha() and not before.startswith("-")), "")
    exit_code, text = help_of(subcommand)
    if exit_code != 0:
        return f"{command.place()}: `{command.text}`: there is no help of {subcommand}"
    known = set(OPTION.findall(text)) | set(OPTION.findall(help_of("")[1]))
    missing = set(OPTION.findall(" ".join(words))) - known
    return (f"{command.place()}: `{command.text}`: the help of {subcommand} lacks "
            f"{', '.join(sorted(missing))}") if missing else ""
