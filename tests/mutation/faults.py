# SPDX-License-Identifier: MIT
"""What small faults a source may have, and how many of them stand in it at once, each asleep until it is let loose.

A fault is an operator swapped, a constant changed, a sign turned, a condition negated, a statement taken out. Asleep,
fault 17 in the expression E that it makes E' is

    (::planted(17) ? (E') : (E))                 an expression; E may itself hold other faults
    ::planted(17) != static_cast<bool>(E)        a negated condition
    if (!::planted(17)) E;                       a statement taken out
    { if (::planted(17)) break; else continue; } a jump

(planted.h). What the compiler wants to know (a constant of an array's size …) cannot sleep: such a file does not compile.
"""
import re
from dataclasses import dataclass
from pathlib import Path

# What is replaced, and by what. The tree is formatted: an operator of two operands stands between spaces.
SWAPS = [
    (r"(?<= )<(?= )", "<="), (r"(?<= )<=(?= )", "<"), (r"(?<= )>(?= )", ">="), (r"(?<= )>=(?= )", ">"),
    (r"(?<= )==(?= )", "!="), (r"(?<= )!=(?= )", "=="), (r"(?<= )&&(?= )", "||"), (r"(?<= )\|\|(?= )", "&&"),
    (r"(?<= )\+(?= )", "-"), (r"(?<= )-(?= )", "+"), (r"(?<= )\*(?= )", "/"), (r"(?<= )/(?= )", "*"),
    (r"(?<= )\+=(?= )", "-="), (r"(?<= )-=(?= )", "+="), (r"(?<= )\*=(?= )", "/="),
    (r"\bstd::min\b", "std::max"), (r"\bstd::max\b", "std::min"), (r"\bstd::sin\b", "std::cos"),
    (r"\bstd::cos\b", "std::sin"), (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"(?<=[(,=?:] )-(?=[A-Za-z0-9(])", ""), (r"(?<=\()-(?=[A-Za-z0-9(])", ""), (r"(?<=return )-(?=[A-Za-z0-9(])", ""),
    (r"(?<=[(!]|\s)!(?=[A-Za-z(])", ""), (r"\bcontinue;", "break;"), (r"\bbreak;", "continue;"),
]
NUMBER = re.compile(r"(?<![\w.'])(\d+)(\.\d+)?(e-?\d+)?(?![\w.'>])")
CONDITION = re.compile(r"\b(if|while) \((?!const |auto )([^;]*)\)(?= \{$| [a-z].*;$)")
STATEMENT = re.compile(r"^ +[A-Za-z_][\w.:\[\]\->*()]*( [-+*/|&]?= .*|\(.*\));$")
# Lines whose change says nothing of behaviour, or that are no code.
LEFT_OUT = re.compile(r"^\s*(#|template|using |static_assert|friend |virtual |\}?\s*//)|\boperator\b|Diagnostic|fmt::format|"
                      r"\breserve\(|= default|= delete|static_cast<void>|if constexpr")
OPENING, CLOSING = "([{", ")]}"
# What an expression cannot go on over to the left: a word that begins a statement.
KEYWORD = re.compile(r"\b(return|else|do|throw|case|const|constexpr|auto|if|while|for|switch)\s*$")


def hidden_text(source):
    """The source with its comments, texts and characters blanked, of the same length."""
    kept = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Za-z])\'(?:\\.|[^\'\\\n])+\'',
                      re.DOTALL)
    return kept.sub(lambda m: re.sub(r"[^\n]", "\x01", m.group()), source)


def changed_number(match):
    whole, part, power = match.groups()
    if part is None and power is None:
        return str(int(whole) + 1)
    if float(match.group()) == 0:
        return "1" + (part or "")
    if power:
        return f"{whole}{part or ''}e{int(power[1:]) + 1}"
    return str(float(match.group()) * 2)


def changes_of(line, blank):
    """(kind, column, end, replacement) of every small fault of a line."""
    for pattern, after in SWAPS:
        for match in re.finditer(pattern, blank):
            kind = "value" if match.group() in ("true", "false") else "jump" if after.endswith(";") else "expression"
            yield kind, match.start(), match.end(), after
    for match in NUMBER.finditer(blank):
        yield "value", match.start(), match.end(), changed_number(match)
    match = CONDITION.search(blank)
    if match and match.group(2).count("(") == match.group(2).count(")"):
        yield "condition", match.start(2), match.end(2), f"!({line[match.start(2):match.end(2)]})"


def mutants_of(path, source):
    """Every small fault of a file; `from` and `to` are where in the text `by` is put."""
    hidden = hidden_text(source)
    lines, blanks = source.split("\n"), hidden.split("\n")
    begin = 0
    for number, (line, blank) in enumerate(zip(lines, blanks)):
        start, begin = begin, begin + len(line) + 1
        if LEFT_OUT.search(blank) or not blank.strip("\x01 "):
            continue
        found = list(changes_of(line, blank))
        above = blanks[number - 1].rstrip("\x01 ") if number else ""
        if STATEMENT.match(blank) and above.endswith((";", "{", "}", ":")) and not in_class(hidden, start):
            found.append(("statement", len(line) - len(line.lstrip()), len(blank.rstrip("\x01 ")), ";"))
        for kind, a, b, after in found:
            yield {"file": path, "line": number + 1, "column": a + 1, "before": line.strip(),
                   "after": (line[:a] + after + line[b:]).strip(), "kind": kind, "from": start + a, "to": start + b,
                   "by": after}


def enclosing(hidden, at):
    """Where the bracket opens that `at` is in; -1 at the top."""
    depth = 0
    for i in range(at - 1, -1, -1):
        if hidden[i] in CLOSING:
            depth += 1
        elif hidden[i] in OPENING:
            if depth == 0:
                return i
            depth -= 1
    return -1


def in_class(hidden, at):
    brace = enclosing(hidden, at)
    head = re.split(r"[;{}]", hidden[max(0, brace - 300):max(brace, 0)])[-1]
    return re.search(r"\b(class|struct|enum)\b[^()]*$", head) is not None


def expression_around(hidden, at, end):
    """The smallest full expression, from and to, that holds what stands from `at` to `end`."""
    assigns = hidden[end - 1] == "=" and hidden[at] in "+-*"
    stops = ",;" if assigns else ",;?:"  # what is assigned is the whole, with what is assigned within it
    begin, depth = at, 0
    while begin > 0:
        c, before = hidden[begin - 1], hidden[begin - 2:begin]
        if c in CLOSING:
            if depth == 0 and c == "}" and re.match(r"\s*\n", hidden[begin:]):
                break
            opening = enclosing(hidden, begin - 1)
            if depth == 0 and c == ")" and re.search(r"\b(if|while|for|switch) $", hidden[:opening]):
                break
            begin = opening
            continue
        if c in OPENING or c in ",;?" or (c == ":" and before != "::" and hidden[begin] != ":"):
            break
        if c == "=" and hidden[begin - 2] not in "=!<>" and hidden[begin] != "=":
            break
        if c == ":" and before == "::":
            begin -= 1
        if c == " " and KEYWORD.search(hidden, max(0, begin - 12), begin):
            break
        begin -= 1
    while end < len(hidden):
        c = hidden[end]
        if c in OPENING:
            depth += 1
        elif c in CLOSING:
            if depth == 0:
                break
            depth -= 1
        elif depth == 0:
            if hidden[end:end + 2] == "::":
                end += 2
                continue
            if c in stops or (c == "=" and not assigns and hidden[end - 1] not in "=!<>" and hidden[end + 1] != "="):
                break
        end += 1
    while hidden[begin] in " \n" and begin < at:
        begin += 1
    while hidden[end - 1] in " \n" and end > at:
        end -= 1
    return begin, end


@dataclass
class Wrap:
    begin: int
    end: int
    ahead: str  # what is written before and behind
    behind: str
    whole: str | None = None  # or instead of it


def in_one_line(source, hidden, begin, end):
    """A piece of the source without its comments and its ends of line."""
    text = "".join(" " if h == "\x01" and c != "\n" and not inside_text(source, hidden, begin + i) else c
                   for i, (c, h) in enumerate(zip(source[begin:end], hidden[begin:end])))
    return text.replace("\n", " ")


def inside_text(source, hidden, at):
    """Whether what is blanked here is a text or a character, not a comment."""
    while at > 0 and hidden[at - 1] == "\x01":
        at -= 1
    return source[at] != "/"


def wrap_of(source, hidden, fault, number):
    asleep, a, b, by = f"::planted({number})", fault["from"], fault["to"], fault["by"]
    if fault["kind"] == "jump":
        return Wrap(a, b, "", "", f"{{ if ({asleep}) {by} else {source[a:b]} }}")
    if fault["kind"] == "value":
        return Wrap(a, b, f"({asleep} ? {by} : ", ")")
    if fault["kind"] == "condition":
        return Wrap(a, b, f"{asleep} != static_cast<bool>(", ")")
    if fault["kind"] == "statement":
        return Wrap(a, b, f"if (!{asleep}) ", "")
    begin, end = expression_around(hidden, a, b)
    other = in_one_line(source, hidden, begin, a) + by + in_one_line(source, hidden, b, end)
    if hidden[a:b] in ("+", "-", "*", "/"):  # a sum and a difference of matrices are two types
        return Wrap(begin, end, f"({asleep} ? ::planted_value({other}, 0) : ::planted_value(", ", 0))")
    if begin == a and hidden[a] == "!" and not re.search("&&|\\|\\|", hidden[a:end]):  # of any type without the `!`
        return Wrap(a, end, f"{asleep} != static_cast<bool>(", ")")
    return Wrap(begin, end, f"({asleep} ? ({other}) : (", "))")


def constant_wrap(path, hidden, at):
    """The word `constexpr` of the variable that is given its value here; None where there is none."""
    begin = hidden.rfind("constexpr", 0, at)
    if begin < 0 or re.search(r";|\) (const )?\{", hidden[begin:at]):
        return None
    brace = enclosing(hidden, begin)
    of_class = in_class(hidden, begin)
    outside = brace < 0 or re.search(r"namespace[^;{}]*$", hidden[:brace])
    shared = (of_class or (outside and path.endswith(".h"))) and not hidden[:begin].rstrip().endswith("inline")
    return Wrap(begin, begin + 9, "", "", "inline const" if shared else "const")


def with_faults(path, source, faults):
    """The source with these faults ({number: fault}) asleep, line by line as it was, and the lines from and to of each;
    one that finds no room beside another is left out."""
    hidden = hidden_text(source)
    wraps, lines = {}, {}
    for number, fault in faults.items():
        wrap = wrap_of(source, hidden, fault, number)
        if any(crosses(wrap, other) for other in wraps.values()):
            continue
        wraps[number] = wrap
        lines[number] = (source.count("\n", 0, wrap.begin) + 1, source.count("\n", 0, wrap.end) + 1)
        constant = constant_wrap(path, hidden, fault["from"])
        if constant:
            wraps[-constant.begin - 1] = constant
    if wraps:  # in the place of the line about the licence
        wraps[0] = Wrap(0, source.index("\n"), "", "", f'#include "{Path(__file__).with_name("planted.h")}"')
    return written(source, 0, len(source), sorted(wraps.values(), key=lambda w: (w.begin, -w.end))), lines


def crosses(a, b):
    """Whether neither holds the other and they are not apart, or what is replaced as a whole would be lost."""
    if a.end <= b.begin or b.end <= a.begin:
        return False
    if a.whole or b.whole:
        inner, outer = (a, b) if a.whole else (b, a)
        return outer.whole is not None or not (outer.begin <= inner.begin and inner.end <= outer.end)
    return not (a.begin <= b.begin and b.end <= a.end) and not (b.begin <= a.begin and a.end <= b.end)


def written(source, begin, end, wraps):
    text, at = "", begin
    while wraps:
        first, *rest = wraps
        inner = [w for w in rest if w.end <= first.end]
        wraps = [w for w in rest if w.end > first.end]
        text += source[at:first.begin]
        text += first.whole or first.ahead + written(source, first.begin, first.end, inner) + first.behind
        at = first.end
    return text + source[at:end]
