"""Finds the commands that Markdown pages show; README.md of this folder says what counts as one."""
import dataclasses
import itertools
import json
import os
import re
import subprocess

PROGRAMS = {"make", "cmake", "ctest", "mpirun", "srun", "salloc", "sbatch", "eval", "cp", "cd",
            "git", "apt", "apt-get", "pip", "python3", "bash", "likwid-perfctr", "perf", ".ci/run",
            ".ci/long"}
DSSBENCH = re.compile(r"^((build/|.*/bin/).*)?dssbench$")
SUBCOMMAND = re.compile(r"^(run|verify|list|experiment|explain|stability|advise|bench|compare"
                        r"|decompose|simulate|completion) ")
SCRIPT = re.compile(r"^[\w./-]+\.(py|sh)$")
ASSIGNMENT = re.compile(r"^[A-Z_]+=\S*$")
COMMENT = re.compile(r"\s+#\s(.*)$")
STATED_EXIT = re.compile(r"\bexits with (\d+)\b")
SHELLS = {"sh", "bash", "shell", "console"}
OPTIONAL_OR_MORE = re.compile(r"(^|\s)\[|\.\.\.")


@dataclasses.dataclass(frozen=True)
class Command:
    """A command as a page shows it."""
    page: str
    line: int
    text: str  # without prompt and comment
    exit_code: int = 0
    is_inline: bool = False
    is_short: bool = False  # written without its first word, dssbench
    output: tuple = ()  # lines of its transcript, without "..."

    def place(self):
        return f"{self.page}:{self.line}"

    def words(self):
        """Its words from the program on, without assignments of variables."""
        return list(itertools.dropwhile(ASSIGNMENT.match, self.text.split()))

    def is_name(self):
        """True of inline code that only names a program or subcommand, with bare options."""
        words = self.words()
        first = 2 if DSSBENCH.match(words[0]) else 1
        is_bare = all(word.startswith("-") for word in words[first:])
        return self.is_inline and words[0] != "make" and is_bare

    def is_synopsis(self):
        """True where brackets or an ellipsis say that it is a pattern of commands."""
        return OPTIONAL_OR_MORE.search(self.text) is not None


def is_command(text):
    """True if the text begins with a program, behind assignments of variables."""
    words = list(itertools.dropwhile(ASSIGNMENT.match, text.split()))
    if not words:
        return False
    is_script = SCRIPT.match(words[0]) is not None and len(words) > 1  # alone it is a file's name
    return is_script or words[0] in PROGRAMS or DSSBENCH.match(words[0]) is not None


def tracked_pages(root):
    """Paths of all pages below the root, relative to it: git's, or all where there is no git."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "*.md"], capture_output=True, text=True)
    if listed.returncode == 0 and listed.stdout:
        return sorted(listed.stdout.splitlines())
    found = []
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if name != "build" and not name.startswith(".")]
        found += [os.path.relpath(os.path.join(folder, name), root)
                  for name in files if name.endswith(".md")]
    return sorted(found)


def split_page(text):
    """The blocks of code, as lists of (line, text) with the language, and the rest as lines."""
    blocks, prose = [], []
    fence, was_blank = None, True
    for number, line in enumerate(text.splitlines(), 1):
        is_fence = line.lstrip().startswith("```")
        if is_fence and fence is None:
            fence = line.strip("` \t")
            blocks.append((fence, []))
        elif is_fence:
            fence = None
        elif fence is not None:
            blocks[-1][1].append((number, line.strip()))
        elif line.startswith("    ") and (was_blank or is_in_block(blocks, number)):
            if not is_in_block(blocks, number):
                blocks.append(("", []))
            blocks[-1][1].append((number, line.strip()))
        else:
            prose.append((number, line))
        was_blank = not line.strip()
    return blocks, prose


def is_in_block(blocks, number):
    """True if the line follows the last block without a gap."""
    return bool(blocks) and bool(blocks[-1][1]) and blocks[-1][1][-1][0] == number - 1


def scenes_of(text):
    """The scenes that a page shows whole, as (name of the file, text)."""
    scenes = []
    for _, lines in split_page(text)[0]:
        shown = "\n".join(line for _, line in lines)
        try:
            scene = json.loads(shown)
            if "bodies" in scene:  # else it only names a scene
                scenes.append((scene["scene"] + ".json", shown))
        except (ValueError, TypeError, KeyError):
            pass
    return scenes


def block_commands(page, language, lines):
    """Commands of a block: lines behind "$ " with their output, or lines that begin so."""
    commands, output = [], None
    for number, line in lines:
        is_prompt = line.startswith("$ ")
        if is_prompt or (output is None and (is_command(line) or (language in SHELLS and line))):
            stated = COMMENT.search(line)
            text = COMMENT.sub("", line.removeprefix("$ "))
            commands.append(Command(page, number, text, stated_exit(stated and stated[1])))
            output = [] if is_prompt else None
        elif line.startswith("[") and commands and commands[-1].line == number - 1:
            commands[-1] = dataclasses.replace(commands[-1], text=f"{commands[-1].text} {line}")
        elif output is not None and line and line != "...":
            last = commands[-1]
            commands[-1] = dataclasses.replace(last, output=last.output + (line,))
    return commands


def stated_exit(words):
    """The exit code that a comment states; 0 if it states none."""
    found = STATED_EXIT.search(words or "")
    return int(found[1]) if found else 0


def inline_commands(page, prose):
    """Commands in inline code, which may go over several lines of a paragraph."""
    commands = []
    for paragraph in paragraphs(prose):
        text = "\n".join(line for _, line in paragraph)
        for found in re.finditer(r"`([^`]+)`([^`]{0,30})", text):
            code = " ".join(found[1].split())
            number = paragraph[0][0] + text.count("\n", 0, found.start())
            if is_command(code):
                commands.append(Command(page, number, code, inline_exit(found[2]), True))
            elif SUBCOMMAND.match(code):
                commands.append(Command(page, number, "dssbench " + code, 0, True, True))
    return commands


def inline_exit(behind):
    """The exit code stated directly behind inline code."""
    return stated_exit(behind) if re.match(r"\s*\(?exits with", behind) else 0


def paragraphs(prose):
    """Lines of prose in groups: a row of a table by itself, else up to a blank line."""
    group = []
    for number, line in prose:
        is_gap = group and number != group[-1][0] + 1
        if group and (is_gap or not line.strip() or line.startswith("|")):
            yield group
            group = []
        if line.startswith("|"):
            yield [(number, line)]
        elif line.strip():
            group.append((number, line))
    if group:
        yield group


def commands_of(page, text):
    """All commands of a page, in its order; alternatives as in a|b give one command each."""
    blocks, prose = split_page(text)
    commands = inline_commands(page, prose)
    for language, lines in blocks:
        commands += block_commands(page, language, lines)
    commands.sort(key=lambda command: command.line)
    return [each for command in commands for each in alternatives(command)]


def alternatives(command):
    """The commands that a word like static|modal stands for; a synopsis stays one."""
    if command.is_synopsis():
        return [command]
    choices = [word.split("|") if re.search(r"\w\|\w", word) else [word]
               for word in command.text.split(" ")]
    return [dataclasses.replace(command, text=" ".join(words))
            for words in itertools.product(*choices)]


def read_page(root, page):
    """The text of a page, whose path is relative to the root."""
    with open(os.path.join(root, page), encoding="utf-8") as file:
        return file.read()


def all_commands(root):
    """The commands of all pages below the root."""
    return [command for page in tracked_pages(root)
            for command in commands_of(page, read_page(root, page))]
