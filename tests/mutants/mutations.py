"""Small mistakes that a programmer could make, as edits of C++ text."""
import dataclasses
import re

# What a mistake changes, and into what. Each pattern matches code, not comments or texts.
RULES = [
    (r"(?<=\s)<(?=\s)", ["<="]), (r"(?<=\s)<=(?=\s)", ["<"]),
    (r"(?<=\s)>(?=\s)", [">="]), (r"(?<=\s)>=(?=\s)", [">"]),
    (r"(?<=\s)==(?=\s)", ["!="]), (r"(?<=\s)!=(?=\s)", ["=="]),
    (r"(?<=\s)\+(?=\s)", ["-"]), (r"(?<=\s)-(?=\s)", ["+"]),
    (r"(?<=\s)\*(?=\s)", ["/"]), (r"(?<=\s)/(?=\s)", ["*"]), (r"(?<=\s)%(?=\s)", ["*"]),
    (r"(?<=\s)&&(?=\s)", ["||"]), (r"(?<=\s)\|\|(?=\s)", ["&&"]),
    (r"(?<=\s)\+=(?=\s)", ["-=", "="]), (r"(?<=\s)-=(?=\s)", ["+="]),
    (r"(?<=\s)\*=(?=\s)", ["/="]), (r"(?<=\s)/=(?=\s)", ["*="]),
    (r"\+\+(?=\w)", ["--"]),
    (r"\bstd::min\b", ["std::max"]), (r"\bstd::max\b", ["std::min"]),
    (r"\btrue\b", ["false"]), (r"\bfalse\b", ["true"]),
    (r"(?<![\w.])\d+(?![\w.])", ["({n} + 1)", "({n} - 1)"]),
    (r"(?<![\w.])\d+\.\d*[1-9]\d*(?![\w.])", ["(1.5 * {n})"]),
    (r"(?<=[(!&|=] )!(?=[\w(])|(?<=\()!(?=[\w(])", [""]),
    (r"(?<=\breturn )(?=[\w(][^;]*;)", ["-"]),
    (r"\bstd::abs\b", [""]),
]
# Lines without behaviour of their own.
LEFT_OUT = re.compile(r"^\s*(#|template|using |namespace|static_assert|throw |.*\bInputError\b"
                      r"|.*\bfmt::|.*constexpr std::size_t \w+ = sizeof)")


@dataclasses.dataclass(frozen=True)
class Mutant:
    """One edit: the text from `begin` to `end` of a file becomes `new`."""
    path: str
    line: int
    begin: int
    end: int
    old: str
    new: str
    code: str
    column: int  # in `code`, from 1 on

    def applied_to(self, text):
        return text[:self.begin] + self.new + text[self.end:]

    def name(self):
        return f"line {self.line}: {self.key()}"

    def key(self):
        """What a list of known mutants names; lines may move."""
        return f"{self.path}: `{self.code}`: `{self.old}` at {self.column} becomes `{self.new}`"


def without_texts(text):
    """The code with comments and string literals blanked, at the same places."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def mutants_of(path, text):
    """All mutants of a file, in the order of their places."""
    code = without_texts(text)
    lines = text.splitlines()
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line) + 1)
    found = []
    for number, line in enumerate(lines, 1):
        begin = starts[number - 1]
        if LEFT_OUT.match(line):
            continue
        for pattern, replacements in RULES:
            for match in re.finditer(pattern, code[begin:begin + len(line)]):
                old = match.group()
                for new in replacements:
                    found.append(Mutant(path, number, begin + match.start(), begin + match.end(),
                                        old, new.format(n=old), line.strip(),
                                        match.start() - len(line) + len(line.lstrip()) + 1))
    return sorted(found, key=lambda m: (m.begin, m.new))
